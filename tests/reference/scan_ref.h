// SPDX-License-Identifier: MIT
// Twin of kernels/runtime/scan.cl: no chunks, no passes.
#pragma once
#include <cstdint>
#include <vector>

namespace penumbra::tests {

struct ScannedValues {
    std::vector<std::uint32_t> before;  ///< [i]: sum of all values in front of value i, modulo 2^32
    std::uint32_t total = 0;            ///< sum of all values, modulo 2^32
};

ScannedValues scanReference(const std::vector<std::uint32_t>& values);

}  // namespace penumbra::tests
