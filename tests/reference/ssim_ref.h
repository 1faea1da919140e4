// SPDX-License-Identifier: MIT
// Double-precision twin of host/metrics/ssim.cpp: one window at a time, straight from the
// definitions of means, variances and covariance.
#pragma once
#include <vector>

namespace penumbra::tests {

/// SSIM map [height, width] of two grey planes in [0, 1]. Windows are 11x11, cut at the edges.
std::vector<double> ssimMap(const std::vector<double>& a, const std::vector<double>& b, int width,
                            int height);

}  // namespace penumbra::tests
