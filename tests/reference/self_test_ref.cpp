// SPDX-License-Identifier: MIT
#include "tests/reference/self_test_ref.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace penumbra::tests {

double squareOfTinyExact() {
    const double t = std::ldexp(1.0, -12);
    return (1 + t) * (1 + t) - 1 - 2 * t;  // 25 bits: exact in double
}

double squareOfTinyRounded() {
    const double t = std::ldexp(1.0, -12);
    return static_cast<double>(static_cast<float>((1 + t) * (1 + t))) - 1 - 2 * t;
}

std::array<std::uint32_t, 4> selfTestReference(int items) {
    double largest = 0;
    for (int i = 0; i < items; ++i) largest = std::max(largest, std::fmod(37.0 * i, items) + 0.5);
    const bool fused = squareOfTinyExact() == std::ldexp(1.0, -24);
    return {std::bit_cast<std::uint32_t>(static_cast<float>(largest)),
            static_cast<std::uint32_t>(items), fused ? 1U : 0U, std::nearbyint(2.5) == 2 ? 1U : 0U};
}

}  // namespace penumbra::tests
