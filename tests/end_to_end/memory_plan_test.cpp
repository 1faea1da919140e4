// SPDX-License-Identifier: MIT
// The memory plan holds: what it admits renders, with the same bytes as without a limit, and what
// it does not admit is refused before the first frame.
#include <cstring>
#include <nlohmann/json.hpp>

#include "host/pipeline.h"
#include "host/visibility/technique.h"
#include "runtime/error.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

RenderOptions optionsFor(const std::string& technique) {
    RenderOptions options;
    options.technique = technique;
    options.width = 200;
    options.height = 120;
    options.lightSamples = "11";
    options.aovs = {"visibility"};
    return options;
}

std::uint64_t plannedBytes(const Pipeline& pipeline) {
    return nlohmann::json::parse(pipeline.statsJson())["memory"]["planned"];
}

class MemoryPlanTest : public testing::TestWithParam<std::string> {};

TEST_P(MemoryPlanTest, WhatItAdmitsRendersTheSameBytes) {
    auto options = optionsFor(GetParam());
    Pipeline unlimited(options);
    const auto frame = unlimited.render(6);
    options.memoryMegabytes = plannedBytes(unlimited) / (1024 * 1024) + 1;
    Pipeline limited(options);
    const auto same = limited.render(6);
    EXPECT_EQ(frame.rgba, same.rgba);
    ASSERT_EQ(frame.channels.size(), same.channels.size());
    for (std::size_t i = 0; i < frame.channels.size(); ++i)
        EXPECT_EQ(frame.channels[i].values, same.channels[i].values);
}

TEST_P(MemoryPlanTest, WhatItDoesNotAdmitIsRefusedBeforeTheFirstFrame) {
    auto options = optionsFor(GetParam());
    options.memoryMegabytes = plannedBytes(Pipeline(options)) / (1024 * 1024);
    try {
        Pipeline refused(options);
        FAIL() << options.memoryMegabytes << " MB are less than the plan, and were admitted";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::outOfMemory);
        EXPECT_NE(std::string(error.what()).find("MB"), std::string::npos) << error.what();
    }
}

std::vector<std::string> allTechniques() {
    std::vector<std::string> names;
    for (const auto& entry : visibility::techniques()) names.emplace_back(entry.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Techniques, MemoryPlanTest, testing::ValuesIn(allTechniques()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace penumbra::tests
