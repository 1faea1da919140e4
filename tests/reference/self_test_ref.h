// SPDX-License-Identifier: MIT
// Twin of kernels/runtime/self_test.cl: the answers of a device that computes, by plain arithmetic.
#pragma once
#include <array>
#include <cstdint>

namespace penumbra::tests {

/// The four results of the kernel for a number of items.
std::array<std::uint32_t, 4> selfTestReference(int items);

/// (1 + t)^2 - 1 - 2 t for t = 1/4096: exactly, and with the product rounded to float.
double squareOfTinyExact();
double squareOfTinyRounded();

}  // namespace penumbra::tests
