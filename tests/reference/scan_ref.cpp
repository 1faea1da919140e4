// SPDX-License-Identifier: MIT
#include "tests/reference/scan_ref.h"

namespace penumbra::tests {

ScannedValues scanReference(const std::vector<std::uint32_t>& values) {
    ScannedValues scanned;
    std::uint64_t sum = 0;  // 2^32 values of 2^32 fit
    for (const auto value : values) {
        scanned.before.push_back(static_cast<std::uint32_t>(sum & 0xffffffffU));
        sum += value;
    }
    scanned.total = static_cast<std::uint32_t>(sum & 0xffffffffU);
    return scanned;
}

}  // namespace penumbra::tests
