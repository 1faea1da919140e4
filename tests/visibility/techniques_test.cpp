// SPDX-License-Identifier: MIT
// What holds for every technique of the list.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"
#include "tests/support/metamorphic.h"

namespace penumbra::tests {
namespace {

const char* const kAbove = "rect:at=0,6,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10";

class TechniquesTest : public testing::TestWithParam<std::string> {
  protected:
    ShadowSetup setup() const {
        ShadowSetup result;
        result.technique = GetParam();
        result.light = kAbove;
        result.eye = {0, 3, 4};
        result.width = 64;
        result.height = 48;
        result.samples = "16";
        return result;
    }
};

void addFloor(SceneBuilder& builder) {
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
}

scene::Scene solids() {
    SceneBuilder builder;
    addFloor(builder);
    builder.addSphere({-0.7F, 0.8F, 0.2F}, 0.5F, 16, 24);
    builder.addBox({0.4F, 0.3F, -0.6F}, {1.0F, 0.9F, 0.1F});
    return builder.scene();
}

std::uint32_t objectAt(const ShadowRun& run, std::size_t pixel) {
    return std::bit_cast<std::uint32_t>(run.planes[GB_OBJECT * run.stride + pixel]);
}

std::pair<float, float> range(const ShadowRun& run) {
    std::pair<float, float> result(2, -1);
    for (std::size_t i = 0; i < run.pixels(); ++i)
        if (run.tested(i))
            result = {std::min(result.first, run.visibility[i]),
                      std::max(result.second, run.visibility[i])};
    return result;
}

TEST_P(TechniquesTest, WithoutCastersAllIsLit) {
    SceneBuilder builder;
    addFloor(builder);
    const auto run = runShadows(builder.scene(), setup());
    EXPECT_EQ(range(run), std::make_pair(1.0F, 1.0F));
}

TEST_P(TechniquesTest, BlendedFragmentsAreReceiversAsOpaquePixelsAre) {
    auto scene = solids();
    auto& floor = scene.meshes[0].primitives[0];
    floor.material = static_cast<int>(scene.materials.size());
    scene.materials.push_back(scene.materials[0]);
    auto above = setup();
    above.width = 61;  // fragments begin in the middle of a vector
    const auto opaque = runShadows(scene, above);
    scene.materials.back().alphaMode = scene::AlphaMode::blend;
    scene.materials.back().baseColor.w = 0.6F;  // essm draws receivers above 0.5
    const auto blended = runShadows(scene, above);
    // One layer: the fragments of the floor come in the order of their pixels
    std::size_t fragment = blended.pixels(), dark = 0;
    for (std::size_t i = 0; i < opaque.pixels(); ++i) {
        if (objectAt(opaque, i) != 1) continue;
        ASSERT_TRUE(blended.covered(fragment));
        EXPECT_EQ(blended.vectorAt(GB_POSITION, fragment), opaque.vectorAt(GB_POSITION, i));
        // pcss turns its filter from receiver to receiver
        EXPECT_NEAR(blended.visibility[fragment], opaque.visibility[i],
                    GetParam() == "pcss" ? 0.1 : 1e-6);
        dark += opaque.visibility[i] < 0.5F;
        ++fragment;
    }
    EXPECT_GT(dark, 50U);
    EXPECT_FALSE(blended.covered(fragment));
}

TEST_P(TechniquesTest, AWideBlockerHidesAllBelowIt) {
    SceneBuilder builder;
    addFloor(builder);
    builder.addQuad({-9, 2, 9}, {18, 0, 0}, {0, 0, -18});
    auto below = setup();
    below.eye = {0, 1, 4};
    const auto run = runShadows(builder.scene(), below);
    EXPECT_EQ(range(run), std::make_pair(0.0F, 0.0F));
}

TEST_P(TechniquesTest, VisibilityLiesBetweenNoneAndAllAndReachesBoth) {
    const auto [least, most] = range(runShadows(solids(), setup()));
    EXPECT_EQ(most, 1.0F);
    EXPECT_GE(least, 0.0F);
    EXPECT_LT(least, 0.05F);
}

TEST_P(TechniquesTest, TheSameInputGivesTheSameBytes) {
    const auto first = runShadows(solids(), setup()), second = runShadows(solids(), setup());
    ASSERT_EQ(first.visibility.size(), second.visibility.size());
    EXPECT_EQ(std::memcmp(first.visibility.data(), second.visibility.data(),
                          first.visibility.size() * sizeof(float)),
              0);
}

TEST_P(TechniquesTest, APointLightGivesTheHardShadowOfRays) {
    auto hard = setup();
    hard.light = "rect:at=0.5,6,0.3;aim=0,0,0;up=0,0,1;size=0x0;radiance=10";
    const auto run = runShadows(solids(), hard);
    hard.technique = "raytrace";
    const auto rays = runShadows(solids(), hard);
    std::size_t wrong = 0, tested = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        ++tested;
        wrong += std::abs(run.visibility[i] - rays.visibility[i]) > 0.5F ? 1 : 0;
    }
    ASSERT_GT(tested, 1000U);
    // Along the shadow's edge a texel decides; exponential maps leak where blockers are close
    EXPECT_LE(wrong, tested / (GetParam() == "essm" ? 25 : 50));
}

INSTANTIATE_TEST_SUITE_P(All, TechniquesTest, testing::ValuesIn(shadowTechniques()),
                         [](const auto& test) { return test.param; });

/// Error against rays to many samples.
double errorOf(ShadowSetup setup, const std::vector<float>& truth) {
    return rmse(runShadows(solids(), setup), truth);
}

TEST(TechniquesErrorTest, ViewsBringMultiViewTechniquesToTheFloorThatTexelsSet) {
    ShadowSetup setup;
    setup.light = "rect:at=0.8,4,0.4;aim=0,0,0;up=0,0,1;size=1.5x1.5;radiance=10";
    setup.eye = {0, 3, 4};
    setup.width = 96;
    setup.height = 72;
    setup.technique = "raytrace";
    setup.samples = "1024";
    const auto truth = runShadows(solids(), setup).visibility;
    for (const std::string technique : {"mvr", "vwss"}) {
        setup.technique = technique;
        setup.settings = {{technique + ".cull", "none"}};
        std::vector<double> errors;
        for (const char* samples : {"4", "16", "64", "256"}) {
            setup.samples = samples;
            errors.push_back(errorOf(setup, truth));
        }
        std::printf("[ RMSE     ] %s with 4, 16, 64, 256 views: %.4f %.4f %.4f %.4f\n",
                    technique.c_str(), errors[0], errors[1], errors[2], errors[3]);
        EXPECT_LT(errors[1], 0.6 * errors[0]);
        EXPECT_LT(errors[2], 0.7 * errors[1]);
        EXPECT_LT(errors[3], 1.05 * errors[2]);
        // The floor falls with the maps' resolution
        std::vector<double> floors;
        for (const char* resolution : {"128", "256", "1024"}) {
            setup.settings[technique + ".resolution"] = resolution;
            floors.push_back(errorOf(setup, truth));
        }
        std::printf("[ RMSE     ] %s with 256 views of 128, 256, 1024: %.4f %.4f %.4f\n",
                    technique.c_str(), floors[0], floors[1], floors[2]);
        EXPECT_LT(floors[1], 0.9 * floors[0]);
        EXPECT_LT(floors[2], 0.9 * floors[1]);
    }
}

TEST(TechniquesErrorTest, MultiViewTechniquesAreCloserToRaysThanSingleViewOnes) {
    ShadowSetup setup;
    setup.light = "rect:at=0.8,4,0.4;aim=0,0,0;up=0,0,1;size=1.5x1.5;radiance=10";
    setup.eye = {0, 3, 4};
    setup.technique = "raytrace";
    setup.samples = "1024";
    const auto truth = runShadows(solids(), setup).visibility;
    std::map<std::string, double> error;
    setup.samples = "64";
    for (const std::string technique : {"vwss", "mvr", "mvss", "pcss", "essm"}) {
        setup.technique = technique;
        error[technique] = errorOf(setup, truth);
        std::printf("[ RMSE     ] %s: %.4f\n", technique.c_str(), error[technique]);
    }
    const double single = std::min(error["pcss"], error["essm"]);
    EXPECT_LT(error["mvr"], 0.5 * single);
    EXPECT_LT(error["vwss"], single);
    EXPECT_LT(error["mvss"], single);
    // Rivals, not scarecrows: each draws the shadow where it belongs
    EXPECT_LT(error["pcss"], 0.12);
    EXPECT_LT(error["essm"], 0.15);
}

}  // namespace
}  // namespace penumbra::tests
