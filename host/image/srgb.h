// SPDX-License-Identifier: MIT
// The sRGB transfer function (IEC 61966-2-1), linear <-> encoded, both in [0, 1].
#pragma once
#include <cmath>

namespace penumbra::image {

template <typename Number>
Number srgbFromLinear(Number linear) {
    return linear <= Number(0.0031308)
               ? Number(12.92) * linear
               : Number(1.055) * std::pow(linear, Number(1 / 2.4)) - Number(0.055);
}

template <typename Number>
Number linearFromSrgb(Number encoded) {
    return encoded <= Number(0.04045)
               ? encoded / Number(12.92)
               : std::pow((encoded + Number(0.055)) / Number(1.055), Number(2.4));
}

}  // namespace penumbra::image
