// SPDX-License-Identifier: MIT
// The self-test's kernel against its twin, and what becomes of a device that fails it.
#include "runtime/self_test.h"

#include "runtime/error.h"
#include "runtime/kernel.h"
#include "tests/reference/self_test_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using U32 = std::uint32_t;

TEST(SelfTestTest, TheDeviceUnderTestPasses) {
    EXPECT_NO_THROW(runtime::selfTest(program("frame")));
}

TEST(SelfTestTest, AnyNumberOfItemsGivesTheTwinsAnswers) {
    runtime::Kernel<int, runtime::Buffer<U32>> kernel(program("frame"), "self_test");
    // 37 and 74: all indices hash alike, or to two values; 65: the last group is nearly empty
    for (const int items : {1, 2, 37, 63, 64, 65, 74, 1000, 4097}) {
        runtime::Buffer<U32> results(device(), "results", std::vector<U32>{0, 0, 0, 0});
        kernel.launch({static_cast<std::uint64_t>(items)}, {64}, items, results);
        const auto twin = selfTestReference(items);
        EXPECT_EQ(results.download(), (std::vector<U32>{twin.begin(), twin.end()})) << items;
    }
}

TEST(SelfTestTest, ARoundedProductWouldBeNoticed) {
    EXPECT_NE(squareOfTinyExact(), squareOfTinyRounded());
}

TEST(SelfTestTest, ADeviceThatFailsIsRefusedWithItsNameAndTheReason) {
    const runtime::Program broken(device(), "frame", {"SELF_TEST_BROKEN"});
    try {
        runtime::selfTest(broken);
        FAIL() << "it passes";
    } catch (const Error& error) {
        const std::string text = error.what();
        EXPECT_EQ(error.code(), ExitCode::noDevice);
        EXPECT_NE(text.find("32-bit atomic increment"), std::string::npos) << text;
        EXPECT_NE(text.find(device().info().name), std::string::npos) << text;
    }
}

}  // namespace
}  // namespace penumbra::tests
