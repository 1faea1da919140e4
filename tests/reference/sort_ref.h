// SPDX-License-Identifier: MIT
// Twin of kernels/runtime/sort.cl from the definition of a stable sort: no digits, no chunks.
#pragma once
#include <cstdint>
#include <utility>
#include <vector>

namespace penumbra::tests {

using KeyValue = std::pair<std::uint32_t, std::uint32_t>;

/// The pairs by ascending key modulo 2^bits; those of equal ones in the order in which they came.
std::vector<KeyValue> sortReference(const std::vector<KeyValue>& pairs, int bits);

}  // namespace penumbra::tests
