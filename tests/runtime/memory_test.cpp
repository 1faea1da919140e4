// SPDX-License-Identifier: MIT
// Buffers, their accounting, the memory plan.
#include <functional>

#include "runtime/buffer.h"
#include "runtime/error.h"
#include "runtime/memory_plan.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using runtime::Device;

void expectOutOfMemory(const std::function<void()>& call, const std::string& part) {
    try {
        call();
        FAIL() << "it fits";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::outOfMemory);
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

class MemoryTest : public testing::Test {
  protected:
    static runtime::DeviceOptions options() {
        runtime::DeviceOptions options;
        options.memoryLimitBytes = 1 << 20;
        return options;
    }
    Device limited_{device().info(), options()};
};

TEST_F(MemoryTest, WhatIsUploadedComesBack) {
    Buffer<int> buffer(limited_, "numbers", std::vector<int>{1, 2, 3, 4});
    EXPECT_EQ(buffer.download(1, 2), (std::vector<int>{2, 3}));
    buffer.fill(7, 2);
    EXPECT_EQ(buffer.download(), (std::vector<int>{7, 7, 3, 4}));
    buffer.uploadLater({9, 8});
    limited_.finish();
    EXPECT_EQ(buffer.download(), (std::vector<int>{9, 8, 3, 4}));
}

TEST_F(MemoryTest, BytesAreCountedAndReleased) {
    {
        Buffer<float> a(limited_, "a", 1000);
        Buffer<float> b = std::move(a);
        EXPECT_EQ(limited_.memory().current, 4000U);
        b.grow(limited_, "b", 500);
        EXPECT_EQ(b.count(), 1000U);
        b.grow(limited_, "b", 2000);
        EXPECT_EQ(limited_.memory().current, 8000U);
    }
    EXPECT_EQ(limited_.memory().current, 0U);
    EXPECT_EQ(limited_.memory().peak, 8000U);
}

TEST_F(MemoryTest, BeyondTheLimitIsRefusedWithTheFigures) {
    Buffer<float> half(limited_, "half", 1 << 17);
    expectOutOfMemory([&] { Buffer<float>(limited_, "too much", 1 << 18); },
                      "too much needs 1.0 MB, 0.5 MB are in use");
}

TEST_F(MemoryTest, APlanThatDoesNotFitNamesItsLargestEntries) {
    runtime::MemoryPlan plan(limited_);
    plan.add("small", 1000);
    EXPECT_NO_THROW(plan.check());
    EXPECT_GT(plan.freeBytes(), 900000U);
    plan.add("depth maps", 2 << 20);
    EXPECT_EQ(plan.freeBytes(), 0U);
    expectOutOfMemory([&] { plan.check(); }, "depth maps 2.0 MB");
}

TEST_F(MemoryTest, ASingleAllocationBeyondTheDevicesLargestIsRefused) {
    runtime::MemoryPlan plan(device());
    plan.add("giant", device().info().maxAllocBytes + 1);
    expectOutOfMemory([&] { plan.check(); }, "giant needs");
}

}  // namespace
}  // namespace penumbra::tests
