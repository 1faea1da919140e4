// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <random>

#include "runtime/scan.h"
#include "runtime/sort.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using U32 = std::uint32_t;

std::vector<U32> randomValues(std::size_t count, U32 limit, U32 seed) {
    std::mt19937 random(seed);
    std::vector<U32> values(count);
    for (auto& value : values) value = static_cast<U32>(random()) % limit;
    return values;
}

class ScanTest : public testing::TestWithParam<U32> {};

TEST_P(ScanTest, EqualsTheRunningSum) {
    const U32 count = GetParam();
    const auto values = randomValues(count, 1000, count);
    Buffer<U32> buffer(device(), "values", std::max<std::size_t>(count, 1)),
        total(device(), "total", 1);
    buffer.upload(values);
    runtime::Scan(program("frame")).run(buffer, count, total);
    std::vector<U32> expected(count);
    std::exclusive_scan(values.begin(), values.end(), expected.begin(), 0U);
    EXPECT_EQ(buffer.download(0, count), expected);
    EXPECT_EQ(total.download()[0], std::accumulate(values.begin(), values.end(), 0U));
}

INSTANTIATE_TEST_SUITE_P(Sizes, ScanTest,
                         testing::Values(0, 1, 2, 63, 64, 65, 1023, 65536, 65537, 1000003));

class SortTest : public testing::TestWithParam<U32> {};

TEST_P(SortTest, EqualsAStableSort) {
    const U32 count = GetParam();
    const auto keys = randomValues(count, count / 3 + 2, count + 1);  // many equal keys
    std::vector<U32> values(count);
    std::iota(values.begin(), values.end(), 0U);
    auto order = values;
    std::stable_sort(order.begin(), order.end(), [&](U32 a, U32 b) { return keys[a] < keys[b]; });
    Buffer<U32> keyBuffer(device(), "keys", std::max<std::size_t>(count, 1));
    Buffer<U32> valueBuffer(device(), "values", std::max<std::size_t>(count, 1));
    keyBuffer.upload(keys);
    valueBuffer.upload(values);
    runtime::Sort(program("frame")).run(keyBuffer, valueBuffer, count);
    EXPECT_EQ(valueBuffer.download(0, count), order);
    auto sorted = keys;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(keyBuffer.download(0, count), sorted);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SortTest, testing::Values(0, 1, 2, 255, 256, 257, 10000, 300007));

TEST(SortBitsTest, AnOddNumberOfDigitsLeavesTheResultInPlace) {
    const std::vector<U32> keys{5, 3, 255, 0, 3}, values{0, 1, 2, 3, 4};
    Buffer<U32> keyBuffer(device(), "keys", keys), valueBuffer(device(), "values", values);
    runtime::Sort(program("frame")).run(keyBuffer, valueBuffer, 5, 8);
    EXPECT_EQ(valueBuffer.download(), (std::vector<U32>{3, 1, 4, 0, 2}));
}

}  // namespace
}  // namespace penumbra::tests
