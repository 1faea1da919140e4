// SPDX-License-Identifier: MIT
// Every kernel on inputs small enough for Oclgrind (tools/check_oclgrind runs the suites named
// Tiny*).
#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/pipeline.h"
#include "runtime/scan.h"
#include "runtime/self_test.h"
#include "runtime/sort.h"
#include "tests/support/fixtures.h"
#include "tests/support/tiny_scene.h"

namespace penumbra::tests {
namespace {

RenderOptions tinyVwssOptions() {
    RenderOptions options = tinyOptions();
    options.settings["vwss.resolution"] = "64";
    return options;
}

Frame renderTiny(const std::map<std::string, std::string>& settings) {
    auto options = tinyVwssOptions();
    for (const auto& [key, value] : settings) options.settings[key] = value;
    options.aovs = {"visibility", "depth-maps"};
    return Pipeline(options, tinyScene()).render(0);
}

class TinyVwssTest : public testing::TestWithParam<std::map<std::string, std::string>> {};

TEST_P(TinyVwssTest, RendersLightAndShadow) {
    const Frame frame = renderTiny(GetParam());
    const auto& visibility = frame.channels.at(0).values;
    EXPECT_EQ(*std::max_element(visibility.begin(), visibility.end()), 1.0F);
    EXPECT_EQ(*std::min_element(visibility.begin(), visibility.end()), 0.0F);
    for (const float value : frame.rgba) EXPECT_TRUE(std::isfinite(value));
}

INSTANTIATE_TEST_SUITE_P(
    Variants, TinyVwssTest,
    testing::Values(
        std::map<std::string, std::string>{{"vwss.parallelism", "owned"}},
        std::map<std::string, std::string>{
            {"vwss.parallelism", "owned"}, {"vwss.depthBits", "16"}, {"vwss.pcf", "9"}},
        std::map<std::string, std::string>{
            {"vwss.parallelism", "full"}, {"vwss.depthBits", "16"}, {"vwss.pcf", "1"}},
        std::map<std::string, std::string>{{"vwss.parallelism", "partial"},
                                           {"vwss.viewsPerPass", "2"},
                                           {"vwss.precision", "half"}},
        std::map<std::string, std::string>{
            {"vwss.parallelism", "serial"}, {"vwss.precision", "fixed"}, {"vwss.pcf", "bilinear"}},
        std::map<std::string, std::string>{{"vwss.buffered", "false"}, {"vwss.viewsPerBatch", "2"}},
        std::map<std::string, std::string>{{"vwss.halfResolution", "true"}}));

TEST(TinyVwssVariantsTest, AllVariantsMakeTheSameMapsAndVisibility) {
    const Frame reference = renderTiny({{"vwss.parallelism", "owned"}});
    const std::map<std::string, std::string> variants[] = {
        {{"vwss.parallelism", "full"}},
        {{"vwss.parallelism", "serial"}},
        {{"vwss.parallelism", "partial"}, {"vwss.viewsPerPass", "2"}, {"vwss.viewsPerBatch", "2"}},
        {{"vwss.buffered", "false"}}};
    for (const auto& variant : variants) {
        const Frame frame = renderTiny(variant);
        ASSERT_EQ(frame.depthMaps.size(), 3U);
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(frame.depthMaps[i].values, reference.depthMaps[i].values);
        EXPECT_EQ(frame.channels[0].values, reference.channels[0].values);
    }
}

TEST(TinyRaytraceTest, AgreesWithTheDepthMapsOnMostPixelsAndCarriesColour) {
    auto options = tinyVwssOptions();
    options.aovs = {"visibility"};
    const auto maps = Pipeline(options, tinyScene()).render(0).channels;
    options.technique = "raytrace";
    options.settings.clear();
    const auto rays = Pipeline(options, tinyScene()).render(0).channels;
    double difference = 0;
    for (std::size_t i = 0; i < rays[0].values.size(); ++i)
        difference += std::abs(rays[0].values[i] - maps[0].values[i]);
    EXPECT_LT(difference / static_cast<double>(rays[0].values.size()), 0.1);
    EXPECT_EQ(*std::min_element(rays[0].values.begin(), rays[0].values.end()), 0.0F);
}

TEST(TinyRaytraceTest, ReceiversOutsideOfNarrowViewsAreTraced) {
    auto options = tinyVwssOptions();
    options.aovs = {"visibility"};
    auto scene = tinyScene();
    scene.lights[0].fovRad = 0.1;  // holds next to nothing
    const auto narrow = Pipeline(options, scene).render(0).channels[0].values;
    options.technique = "raytrace";
    options.settings.clear();
    const auto rays = Pipeline(options, tinyScene()).render(0).channels;
    std::size_t equal = 0;
    for (std::size_t i = 0; i < narrow.size(); ++i) {
        const float mean = (rays[0].values[i] + rays[1].values[i] + rays[2].values[i]) / 3;
        equal += std::abs(narrow[i] - mean) < 1e-3F ? 1 : 0;
    }
    EXPECT_GT(equal, narrow.size() * 9 / 10);
}

TEST(TinyTemporalTest, AveragesAStillSceneToItself) {
    auto options = tinyVwssOptions();
    options.aovs = {"visibility"};
    const Frame once = Pipeline(options, tinyScene()).render(0);
    options.temporal = 3;
    Pipeline averaged(options, tinyScene());
    for (int number : {0, 1}) {
        const auto values = averaged.render(number).channels[0].values;
        for (std::size_t i = 0; i < values.size(); ++i)
            EXPECT_NEAR(values[i], once.channels[0].values[i], 1e-6);  // a sum of three, divided
    }
}

TEST(TinyRuntimeTest, ScanSortAndSelfTestRun) {
    runtime::selfTest(program("frame"));
    runtime::Buffer<std::uint32_t> keys(device(), "keys", std::vector<std::uint32_t>{5, 1, 5, 0}),
        values(device(), "values", std::vector<std::uint32_t>{0, 1, 2, 3}),
        total(device(), "total", 1);
    runtime::Sort(program("frame")).run(keys, values, 4, 8);
    EXPECT_EQ(values.download(), (std::vector<std::uint32_t>{3, 1, 0, 2}));
    runtime::Scan(program("frame")).run(keys, 4, total);
    EXPECT_EQ(total.download()[0], 11U);
}

TEST(TinyGBufferTest, BothRasterPathsAgree) {
    const auto scene = tinyScene();
    const auto pose = scene::poseAt(scene, {}, 0);
    geometry::Geometry geometry(program("frame"), scene, {0, 0, 0});
    const auto& mesh = geometry.run(pose);
    scene::CameraFrame camera;
    camera.worldFromCamera = scene::lookAt({2.5, 2.5, 3.5}, {0, 0.5, 0}, {0, 1, 0});
    gbuffer::GBufferPass narrow(program("frame"), 20, 12, false),
        wide(program("frame"), 20, 12, true);
    EXPECT_FALSE(narrow.usesAtomics64());
    const auto a = narrow.run(mesh, camera, {0, 0, 0}).planes.download();
    const auto b = wide.run(mesh, camera, {0, 0, 0}).planes.download();
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
    EXPECT_EQ(geometry.counts().nonFiniteVertices, 0U);
}

}  // namespace
}  // namespace penumbra::tests
