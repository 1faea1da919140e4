// SPDX-License-Identifier: MIT
// Every real model renders a frame in which something is seen, finite, and partly in shadow.
#include <algorithm>
#include <cmath>

#include "host/pipeline.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

class AssetFrameTest : public testing::TestWithParam<const char*> {};

TEST_P(AssetFrameTest, RendersWithShadows) {
    if (assetFolder().empty())
        GTEST_SKIP() << "the models are absent; set PENUMBRA_ASSETS to their folder";
    RenderOptions options;
    options.scene = assetFolder() + "/" + GetParam();
    options.width = 160;
    options.height = 90;
    options.lightSamples = "8";
    options.settings["vwss.resolution"] = "256";
    options.ground = true;
    options.camera = "auto";
    options.device = std::getenv("PENUMBRA_DEVICE") ? "" : "cpu";
    options.aovs = {"visibility", "id"};
    Pipeline pipeline(options);
    const Frame frame = pipeline.render(10);
    const auto& ids = frame.channels.at(0).ids;
    const auto ground = *std::max_element(ids.begin(), ids.end());  // the last node
    EXPECT_GT(
        std::count_if(ids.begin(), ids.end(), [&](auto id) { return id != 0 && id != ground; }),
        50);
    const auto& visibility = frame.channels.at(1).values;
    std::size_t shadowed = 0;
    for (std::size_t i = 0; i < ids.size(); ++i)
        shadowed += ids[i] != 0 && visibility[i] < 0.5F ? 1 : 0;
    EXPECT_GT(shadowed, 20U) << "no shadow";
    for (const float value : frame.rgba) ASSERT_TRUE(std::isfinite(value) && value >= 0);
}

INSTANTIATE_TEST_SUITE_P(
    Models, AssetFrameTest,
    testing::Values("AlphaBlendModeTest/AlphaBlendModeTest.glb",
                    "AnimatedMorphCube/AnimatedMorphCube.glb", "BoxAnimated/BoxAnimated.glb",
                    "CesiumMan/CesiumMan.glb", "DutchShip/dutch_ship_medium_1k.gltf", "Fox/Fox.glb",
                    "GlassVaseFlowers/GlassVaseFlowers.glb", "Greenman/greenman.glb",
                    "InterpolationTest/InterpolationTest.glb", "Knight/Knight.glb", "Mage/Mage.glb",
                    "MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb",
                    "OrientationTest/OrientationTest.glb",
                    "RecursiveSkeletons/RecursiveSkeletons.glb", "RiggedFigure/RiggedFigure.glb",
                    "RiggedSimple/RiggedSimple.glb", "Robot/robot.glb",
                    "RobotPartsA/robot_parts_a.gltf", "Room/room.glb", "SimpleSkin/SimpleSkin.gltf",
                    "SimpleSparseAccessor/SimpleSparseAccessor.gltf",
                    "StainedGlassLamp/StainedGlassLamp.gltf", "ToyCar/ToyCar.gltf"));

}  // namespace
}  // namespace penumbra::tests
