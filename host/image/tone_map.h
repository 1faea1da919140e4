// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "host/penumbra.h"

namespace penumbra::image {

/// Khronos PBR Neutral of exposed linear RGB, for looking; sRGB bytes [height, width, 3]. Pixels
/// without coverage show a dark grey.
std::vector<std::uint8_t> toneMap(const Frame& frame);

/// The same of one pixel, linear in [0, 1] and not encoded: `rgb` is scene-referred and linear,
/// `alpha` coverage, `gain` Frame::exposure. Negative values count as 0, infinite ones as 1e30; a
/// pixel with a NaN becomes NaN in all channels.
void toneMapPixel(float (&rgb)[3], float alpha, float gain);

/// The tone curve alone, linear to linear in [0, 1].
void pbrNeutral(float (&rgb)[3]);

}  // namespace penumbra::image
