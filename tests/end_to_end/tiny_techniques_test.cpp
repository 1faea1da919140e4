// SPDX-License-Identifier: MIT
// The rivals of vwss on inputs small enough for Oclgrind (tools/check_oclgrind runs the suites
// named Tiny*).
#include <algorithm>
#include <cmath>

#include "host/pipeline.h"
#include "tests/support/fixtures.h"
#include "tests/support/tiny_scene.h"

namespace penumbra::tests {
namespace {

struct Rival {
    std::string technique, pattern;
    std::map<std::string, std::string> settings;
};

RenderOptions optionsOf(const Rival& rival) {
    RenderOptions options = tinyOptions();
    options.technique = rival.technique;
    if (!rival.pattern.empty()) options.lightPattern = rival.pattern;
    options.settings = rival.settings;
    if (rival.technique != "raytrace" && rival.technique != "raster4d")
        options.settings[rival.technique + ".resolution"] = "64";
    options.aovs = {"visibility"};
    return options;
}

class TinyRivalTest : public testing::TestWithParam<Rival> {};

TEST_P(TinyRivalTest, RendersLightAndShadow) {
    const Frame frame = Pipeline(optionsOf(GetParam()), tinyScene()).render(0);
    const auto& visibility = frame.channels.at(0).values;
    EXPECT_EQ(*std::max_element(visibility.begin(), visibility.end()), 1.0F);
    EXPECT_LT(*std::min_element(visibility.begin(), visibility.end()), 0.2F);
    for (const float value : frame.rgba) EXPECT_TRUE(std::isfinite(value));
}

INSTANTIATE_TEST_SUITE_P(
    Variants, TinyRivalTest,
    testing::Values(Rival{"mvr", "", {}}, Rival{"mvr", "", {{"mvr.form", "textbook"}}},
                    Rival{"mvr", "", {{"mvr.coverage", "conservative"}, {"mvr.pcf", "bilinear"}}},
                    Rival{"mvr", "", {{"mvr.depthBits", "16"}, {"mvr.viewsPerBatch", "2"}}},
                    Rival{"mvr", "", {{"mvr.depthBits", "16"}, {"mvr.form", "textbook"}}},
                    Rival{"mvss", "", {{"mvss.maps", "4"}}},
                    Rival{"pcss", "", {{"pcss.blockerTaps", "9"}, {"pcss.filterTaps", "7"}}},
                    Rival{"pcss",
                          "",
                          {{"pcss.pattern", "poisson"},
                           {"pcss.halfResolution", "true"},
                           {"pcss.blockerTaps", "4"},
                           {"pcss.filterTaps", "4"}}},
                    Rival{"essm", "", {}}, Rival{"mlsm", "", {}},
                    Rival{"mlsm",
                          "",
                          {{"mlsm.build", "list"},
                           {"mlsm.halfResolution", "true"},
                           {"mlsm.antialias", "true"},
                           {"mlsm.accumulateLookup", "multiply"},
                           {"mlsm.join", "true"},
                           {"mlsm.stackFrom", "16"}}},
                    Rival{"raytrace", "random", {}}, Rival{"raster4d", "", {}},
                    Rival{"raster4d", "jittered", {}},
                    Rival{"raster4d",
                          "",
                          {{"raster4d.method", "grid"},
                           {"raster4d.grid", "8"},
                           {"raster4d.onePixel", "false"},
                           {"raster4d.reject", "false"}}}));

TEST(TinyMapRasterTest, BothFormsMakeTheSameMapsAndVisibility) {
    for (const char* bits : {"32", "16"}) {
        auto options = optionsOf({"mvr", "", {{"mvr.depthBits", bits}}});
        options.aovs = {"visibility", "depth-maps"};
        const Frame full = Pipeline(options, tinyScene()).render(0);
        options.settings["mvr.form"] = "textbook";
        const Frame textbook = Pipeline(options, tinyScene()).render(0);
        ASSERT_EQ(full.depthMaps.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(full.depthMaps[i].values, textbook.depthMaps[i].values) << bits;
        EXPECT_EQ(full.channels[0].values, textbook.channels[0].values) << bits;
    }
}

}  // namespace
}  // namespace penumbra::tests
