// SPDX-License-Identifier: MIT
// Double-precision twin of kernels/visibility/depth_warp.cl: one point at a time, no lanes, no
// atomics.
#pragma once
#include <vector>

namespace penumbra::tests {

struct WarpPoint {
    double a, b, w;  ///< as kernels/shared/multi_view.h
};

/// Depth map [row, column] of the view with offsets kx, ky: the largest depth per texel, 0 where
/// none lands; points outside are clipped, and nearer ones than the near plane keep depth 1.
std::vector<double> warpPoints(const std::vector<WarpPoint>& points, double kx, double ky,
                               int size);

}  // namespace penumbra::tests
