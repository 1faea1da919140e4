// SPDX-License-Identifier: MIT
#include "tests/reference/depth_warp_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {

std::vector<double> warpPoints(const std::vector<WarpPoint>& points, double kx, double ky,
                               int size) {
    std::vector<double> map(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), 0.0);
    for (const auto& p : points) {
        const double column = std::floor(p.a - kx * p.w), row = std::floor(p.b - ky * p.w);
        if (column < 0 || row < 0 || column >= size || row >= size) continue;
        double& texel = map[static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
                            static_cast<std::size_t>(column)];
        texel = std::max(texel, std::min(p.w, 1.0));
    }
    return map;
}

}  // namespace penumbra::tests
