// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "host/penumbra.h"

namespace penumbra::image {

/// Khronos PBR Neutral of exposed linear RGB, for looking; sRGB bytes [height, width, 3]. Pixels
/// without coverage show a dark grey.
std::vector<std::uint8_t> toneMap(const Frame& frame);

/// The tone curve alone, linear to linear in [0, 1].
void pbrNeutral(float (&rgb)[3]);

}  // namespace penumbra::image
