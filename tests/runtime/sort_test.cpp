// SPDX-License-Identifier: MIT
// The radix sort against the twin: order, stability, and what bits leave out.
#include "runtime/sort.h"

#include <random>

#include "tests/reference/sort_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using U32 = std::uint32_t;

/// Pairs whose value is their place, with keys below `limit`.
std::vector<KeyValue> randomPairs(std::size_t count, U32 limit) {
    std::mt19937 random(static_cast<U32>(count) + limit);
    std::vector<KeyValue> pairs;
    for (std::size_t i = 0; i < count; ++i)
        pairs.emplace_back(static_cast<U32>(random()) % limit, static_cast<U32>(i));
    return pairs;
}

/// Sorts the first `count` pairs on the device and compares all of them.
void expectSort(runtime::Sort& sort, const std::vector<KeyValue>& pairs, std::size_t count,
                int bits) {
    std::vector<U32> keys, values;
    for (const auto& [key, value] : pairs) keys.push_back(key), values.push_back(value);
    Buffer<U32> keyBuffer(device(), "keys", std::max<std::size_t>(keys.size(), 1));
    Buffer<U32> valueBuffer(device(), "values", std::max<std::size_t>(keys.size(), 1));
    keyBuffer.upload(keys);
    valueBuffer.upload(values);
    sort.run(keyBuffer, valueBuffer, static_cast<U32>(count), bits);
    const auto twin =
        sortReference({pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(count)}, bits);
    for (std::size_t i = 0; i < count; ++i) keys[i] = twin[i].first, values[i] = twin[i].second;
    EXPECT_EQ(keyBuffer.download(0, keys.size()), keys) << count << " of " << bits << " bits";
    EXPECT_EQ(valueBuffer.download(0, keys.size()), values) << count << " of " << bits << " bits";
}

class SortTest : public testing::TestWithParam<U32> {};

TEST_P(SortTest, EqualsAStableSort) {
    runtime::Sort sort(program("frame"));
    const U32 count = GetParam();
    expectSort(sort, randomPairs(count, count / 3 + 2), count, 32);  // many equal keys
    expectSort(sort, randomPairs(count, 0xffffffffU), count, 32);
}

TEST_P(SortTest, LooksAtTheLowestBitsAlone) {
    runtime::Sort sort(program("frame"));
    for (const int bits : {8, 16, 24})
        expectSort(sort, randomPairs(GetParam(), 0xffffffffU), GetParam(), bits);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SortTest,
                         testing::Values(0, 1, 2, 3, 255, 256, 257, 511, 513, 10000, 65537,
                                         300007));

TEST(SortOrderTest, EqualFallingAndExtremeKeysKeepTheirPairs) {
    runtime::Sort sort(program("frame"));
    std::vector<KeyValue> equal, falling, extreme;
    for (U32 i = 0; i < 1000; ++i) {
        equal.emplace_back(7, i);
        falling.emplace_back(1000 - i, i);
        extreme.emplace_back(i % 3 == 0 ? 0 : i % 3 == 1 ? 0xffffffffU : 0x80000000U, i);
    }
    for (const auto& pairs : {equal, falling, extreme}) expectSort(sort, pairs, pairs.size(), 32);
}

TEST(SortOrderTest, PairsBehindTheCountAreLeftAloneAndASmallerSortFollowsALargerOne) {
    runtime::Sort sort(program("frame"));
    const auto pairs = randomPairs(5003, 900);
    for (const std::size_t count : {5003U, 5000U, 257U, 2U, 1U, 0U})
        for (const int bits : {8, 32}) expectSort(sort, pairs, count, bits);
}

}  // namespace
}  // namespace penumbra::tests
