// SPDX-License-Identifier: MIT
// Double-precision twin of host/metrics/flip.cpp: the equations of [FLIP] as they stand, with
// two-dimensional kernels, each pixel on its own.
#pragma once
#include <array>
#include <vector>

namespace penumbra::tests {

using Rgb = std::array<double, 3>;  ///< sRGB-encoded, in [0, 1]

/// FLIP map [height, width].
std::vector<double> flipMap(const std::vector<Rgb>& reference, const std::vector<Rgb>& test,
                            int width, int height, double pixelsPerDegree);

}  // namespace penumbra::tests
