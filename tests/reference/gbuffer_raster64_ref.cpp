// SPDX-License-Identifier: MIT
#include "tests/reference/gbuffer_raster64_ref.h"

#include <bit>

namespace penumbra::tests {

std::uint64_t nearestWord(const std::vector<RasterFragment>& fragments) {
    const RasterFragment* nearest = nullptr;
    for (const auto& f : fragments) {
        const bool nearer =
            nearest == nullptr || static_cast<float>(f.depth) > static_cast<float>(nearest->depth);
        const bool first = nearest != nullptr &&
                           static_cast<float>(f.depth) == static_cast<float>(nearest->depth) &&
                           f.triangle < nearest->triangle;
        if (nearer || first) nearest = &f;
    }
    if (nearest == nullptr) return 0;
    const auto depth = std::bit_cast<std::uint32_t>(static_cast<float>(nearest->depth));
    return std::uint64_t{depth} << 32 | ~static_cast<std::uint32_t>(nearest->triangle);
}

}  // namespace penumbra::tests
