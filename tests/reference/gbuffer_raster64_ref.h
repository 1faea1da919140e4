// SPDX-License-Identifier: MIT
// Twin of kernels/gbuffer/gbuffer_raster64.cl: what the fragments of a pixel, those of
// gbuffer_raster_ref.h, leave in its word, in whatever order they come.
#pragma once
#include <cstdint>
#include <vector>

#include "tests/reference/gbuffer_raster_ref.h"

namespace penumbra::tests {

/// Float bits of the nearest depth << 32 | ~triangle, the lowest index among equal depths; 0: none.
std::uint64_t nearestWord(const std::vector<RasterFragment>& fragments);

}  // namespace penumbra::tests
