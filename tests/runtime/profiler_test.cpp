// SPDX-License-Identifier: MIT
// Stages timed by timestamps that tests feed, and by the wall clock where a device has none.
#include "runtime/profiler.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host/pipeline.h"
#include "runtime/kernel.h"
#include "runtime/opencl.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Timestamps;
using U32 = std::uint32_t;

/// A device with profiling, a kernel to launch, and timestamps of our own.
class ProfilerTest : public testing::Test {
  protected:
    static runtime::DeviceOptions options() {
        runtime::DeviceOptions options;
        options.profiling = true;
        return options;
    }
    void launch(const char* stage, int items = 1000) {
        own_.profiler().beginStage(stage);
        kernel_.launch({static_cast<std::uint64_t>(items)}, {64}, items, results_);
    }
    runtime::Device own_{device().info(), options()};
    runtime::Program frame_{own_, "frame"};
    runtime::Kernel<int, runtime::Buffer<U32>> kernel_{frame_, "self_test"};
    runtime::Buffer<U32> results_{own_, "results", std::vector<U32>{0, 0, 0, 0}};
};

TEST_F(ProfilerTest, StagesAddUpTheirLaunchesAndSpanFromTheFirstStartToTheLastEnd) {
    // Read once to see whether timestamps work, then again for the three launches
    const std::vector<Timestamps> given = {
        {1, 2}, {10'000'000, 11'000'000}, {20'000'000, 24'000'000}, {30'000'000, 32'000'000}};
    std::size_t next = 0;
    own_.profiler().readTimestampsWith([&](const cl::Event&) { return given.at(next++); });
    launch("first");
    launch("second");
    launch("first");
    const auto stages = own_.profiler().collect();
    ASSERT_EQ(stages.size(), 2U);
    EXPECT_TRUE(own_.profiler().timestampsWork());
    EXPECT_EQ(stages[0].name, "first");
    EXPECT_NEAR(stages[0].deviceMs, 3, 1e-9);
    EXPECT_NEAR(stages[0].wallMs, 22, 1e-9);
    EXPECT_NEAR(stages[0].maxLaunchMs, 2, 1e-9);
    EXPECT_EQ(stages[0].launches, 2);
    EXPECT_EQ(stages[1].name, "second");
    EXPECT_NEAR(stages[1].deviceMs, 4, 1e-9);
    EXPECT_TRUE(own_.profiler().collect().empty());
}

TEST_F(ProfilerTest, ZeroTimestampsGiveWayToTheWallClockOfEachLaunch) {
    own_.profiler().readTimestampsWith([](const cl::Event&) { return Timestamps{}; });
    const auto before = std::chrono::steady_clock::now();
    for (int i = 0; i < 5; ++i) launch("zero", 100000);
    const double passed =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before)
            .count();
    const auto stages = own_.profiler().collect();
    EXPECT_FALSE(own_.profiler().timestampsWork());
    ASSERT_EQ(stages.size(), 1U);
    EXPECT_EQ(stages[0].launches, 5);
    // Each launch was waited for, so that its time lies within what passed here
    EXPECT_GT(stages[0].maxLaunchMs, 0);
    EXPECT_GT(stages[0].deviceMs, stages[0].maxLaunchMs);  // each of the five has a time
    EXPECT_LE(stages[0].deviceMs, passed);
    EXPECT_GT(stages[0].deviceMs, 0.2 * passed);
    EXPECT_EQ(stages[0].wallMs, stages[0].deviceMs);
}

TEST_F(ProfilerTest, AQueueThatKeepsNoTimestampsIsTimedByTheWallClockToo) {
    runtime::Device plain(device().info());
    runtime::Profiler profiler(plain, true);
    profiler.beginStage("marker");
    plain.queue().enqueueMarkerWithWaitList(nullptr, profiler.newEvent());
    profiler.launched();
    const auto stages = profiler.collect();
    EXPECT_FALSE(profiler.timestampsWork());
    ASSERT_EQ(stages.size(), 1U);
    EXPECT_GT(stages[0].deviceMs, 0);
}

/// Stages of a frame of the built-in scene and the warnings it gave.
std::pair<nlohmann::json, std::vector<std::string>> profiledFrame(bool zero) {
    RenderOptions options;
    options.width = 16, options.height = 9;
    options.lightSamples = "2";
    options.settings = {{"vwss.resolution", "64"}};
    options.device = "cpu";
    options.profile = true;
    Pipeline pipeline(options);
    if (zero)
        pipeline.device().profiler().readTimestampsWith(
            [](const cl::Event&) { return Timestamps{}; });
    const auto frame = pipeline.render(0);
    auto warnings = pipeline.takeWarnings();
    warnings.push_back("device " + pipeline.device().info().name);
    return {nlohmann::json::parse(frame.statsJson)["stages"], warnings};
}

TEST_F(ProfilerTest, AFrameOnADeviceWithZeroTimestampsNamesItAndStillHasTimes) {
    for (const bool zero : {true, false}) {
        const auto [stages, lines] = profiledFrame(zero);
        const auto& warnings = lines;  // clang 14 captures no bindings
        const auto named = std::count_if(warnings.begin(), warnings.end(), [&](const auto& text) {
            return text.find("timestamps of " + warnings.back() + " are zero") != std::string::npos;
        });
        EXPECT_EQ(named, zero ? 1 : 0);
        EXPECT_GT(stages.size(), 4U);
        for (const auto& stage : stages) EXPECT_GT(stage["deviceMs"].get<double>(), 0) << stage;
    }
}

}  // namespace
}  // namespace penumbra::tests
