// SPDX-License-Identifier: MIT
// Prefix sums against the twin, on counts around the chunks' borders.
#include "runtime/scan.h"

#include <random>

#include "tests/reference/scan_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using U32 = std::uint32_t;

std::vector<U32> randomValues(std::size_t count, U32 limit) {
    std::mt19937 random(static_cast<U32>(count));
    std::vector<U32> values(count);
    for (auto& value : values) value = static_cast<U32>(random()) % limit;
    return values;
}

/// Scans the first `count` of the values on the device and compares all of them.
void expectScan(runtime::Scan& scan, const std::vector<U32>& values, U32 count) {
    Buffer<U32> buffer(device(), "values", std::max<std::size_t>(values.size(), 1));
    Buffer<U32> total(device(), "total", std::vector<U32>{0xdeadbeefU});
    buffer.upload(values);
    scan.run(buffer, count, total);
    const auto twin = scanReference({values.begin(), values.begin() + count});
    auto expected = values;
    std::copy(twin.before.begin(), twin.before.end(), expected.begin());
    EXPECT_EQ(buffer.download(0, values.size()), expected) << count;
    EXPECT_EQ(total.download()[0], twin.total) << count;
}

class ScanTest : public testing::TestWithParam<U32> {};

TEST_P(ScanTest, EqualsTheRunningSum) {
    runtime::Scan scan(program("frame"));
    expectScan(scan, randomValues(GetParam(), 1000), GetParam());
}

TEST_P(ScanTest, WrapsWhereSumsPass32Bits) {
    runtime::Scan scan(program("frame"));
    expectScan(scan, randomValues(GetParam(), 0xffffffffU), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Sizes, ScanTest,
                         testing::Values(0, 1, 2, 63, 64, 65, 127, 129, 1023, 1025, 65535, 65536,
                                         65537, 131073, 1000003));

TEST(ScanReuseTest, ValuesBehindTheCountAreLeftAloneAndASmallerScanFollowsALargerOne) {
    runtime::Scan scan(program("frame"));
    const auto values = randomValues(70001, 1000);
    for (const U32 count : {70001U, 69999U, 65U, 64U, 3U, 0U}) expectScan(scan, values, count);
}

}  // namespace
}  // namespace penumbra::tests
