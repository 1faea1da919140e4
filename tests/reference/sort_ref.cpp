// SPDX-License-Identifier: MIT
#include "tests/reference/sort_ref.h"

#include <map>

namespace penumbra::tests {

std::vector<KeyValue> sortReference(const std::vector<KeyValue>& pairs, int bits) {
    std::map<std::uint64_t, std::vector<KeyValue>> byKey;
    for (const auto& pair : pairs) byKey[pair.first % (std::uint64_t{1} << bits)].push_back(pair);
    std::vector<KeyValue> sorted;
    for (const auto& [key, equal] : byKey) sorted.insert(sorted.end(), equal.begin(), equal.end());
    return sorted;
}

}  // namespace penumbra::tests
