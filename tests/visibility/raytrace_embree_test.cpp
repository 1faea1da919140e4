// SPDX-License-Identifier: MIT
// The ray-traced reference against Embree, ray by ray on the same triangles, and what rays must
// obey.
#include <cmath>
#include <cstdio>

#include "host/scene/builtin.h"
#include "host/scene/gltf_loader.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/embree_scene.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

struct Agreement {
    std::size_t rays = 0, different = 0;
};

/// Compares the number of samples that each pixel sees; a difference of k counts as k rays.
Agreement agreement(const ShadowRun& run) {
    const EmbreeScene embree(run.casters);
    const auto samples = run.samplePoints();
    Agreement result;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        const glm::vec3 origin = run.shadowOrigin(i), normal = run.vectorAt(GB_GEOMETRIC, i);
        int seen = 0;
        for (const auto& sample : samples)
            seen += glm::dot(sample - origin, normal) > 0 && !embree.occluded(origin, sample);
        const double ours =
            static_cast<double>(run.visibility[i]) * static_cast<double>(samples.size());
        result.rays += samples.size();
        result.different += static_cast<std::size_t>(std::lround(std::abs(ours - seen)));
    }
    return result;
}

void expectAgreement(const char* name, const scene::Scene& scene, ShadowSetup setup) {
    setup.technique = "raytrace";
    const auto result = agreement(runShadows(scene, setup));
    std::printf("[ RAYS     ] %s: %zu of %zu differ from Embree\n", name, result.different,
                result.rays);
    EXPECT_GT(result.rays, 100000U);
    // Rays through edges: rounding differs, and neither is wrong
    EXPECT_LE(static_cast<double>(result.different), 1e-5 * static_cast<double>(result.rays) + 1)
        << name;
}

TEST(RaytraceEmbree, TheBuiltinSceneAgreesRayByRay) {
    ShadowSetup setup;
    setup.placedCamera = false;
    expectAgreement("built-in", scene::loadBuiltinScene(), setup);
}

TEST(RaytraceEmbree, ASphereOverAFloorAgreesRayByRay) {
    SceneBuilder builder;
    builder.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, false);
    builder.addSphere({0, 1, 0}, 0.8F);
    ShadowSetup setup;
    setup.light = "rect:at=1,4,1;aim=0,0,0;size=1x1;radiance=10";
    expectAgreement("sphere", builder.scene(), setup);
}

class RaytraceEmbreeAssets : public testing::TestWithParam<const char*> {};

TEST_P(RaytraceEmbreeAssets, AgreeRayByRay) {
    if (assetFolder().empty())
        GTEST_SKIP() << "the models are absent; set PENUMBRA_ASSETS to their folder";
    auto scene = scene::loadGltf(assetFolder() + "/" + GetParam());
    scene.cameras.clear();
    for (auto& m : scene.materials) m.alphaMode = scene::AlphaMode::opaque;  // as Embree sees them
    scene::addGround(scene, scene::clipBounds(scene, scene::chooseAnimations(scene, "")));
    ShadowSetup setup;
    setup.placedCamera = false;
    setup.samples = "16";
    setup.seconds = 0.4;
    expectAgreement(GetParam(), scene, setup);
}

INSTANTIATE_TEST_SUITE_P(
    Models, RaytraceEmbreeAssets,
    testing::Values("CesiumMan/CesiumMan.glb", "Knight/Knight.glb",
                    "RecursiveSkeletons/RecursiveSkeletons.glb", "RobotPartsA/robot_parts_a.gltf",
                    "MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb"));

/// Mean visibility of the pixels tested.
double meanVisibility(const scene::Scene& scene, const std::string& light, int channel = 0) {
    ShadowSetup setup;
    setup.technique = "raytrace";
    setup.light = light;
    setup.eye = {0, 0.3, 3};
    const auto run = runShadows(scene, setup);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i)
        if (run.tested(i)) {
            sum += run.visibility[static_cast<std::size_t>(channel) * run.stride + i];
            ++count;
        }
    return count ? sum / static_cast<double>(count) : -1;
}

const char* const kAbove = "rect:at=0,6,0;aim=0,0,0;size=1x1;radiance=10";

TEST(RaytraceTest, AClosedBoxHidesAllOfItsInside) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);  // the floor inside
    builder.addBox({-4, -4, -4}, {4, 4, 4});
    EXPECT_EQ(meanVisibility(builder.scene(), kAbove), 0);
}

TEST(RaytraceTest, AFinelyCutSheetHasNoCracks) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addSphere({0, 0, 0}, 3.3F, 61, 127);
    EXPECT_EQ(meanVisibility(builder.scene(), kAbove), 0);
}

TEST(RaytraceTest, BlendedSheetsMultiplyTheirColours) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    for (int sheet = 0; sheet < 2; ++sheet) {
        const int node =
            builder.addQuad({-9, 2.0F + static_cast<float>(sheet), 9}, {18, 0, 0}, {0, 0, -18});
        builder.scene()
            .meshes[static_cast<std::size_t>(
                builder.scene().nodes[static_cast<std::size_t>(node)].mesh)]
            .primitives[0]
            .material = 1;
    }
    scene::Material glass = builder.material();
    glass.alphaMode = scene::AlphaMode::blend;
    glass.baseColor = {1.0F, 0.5F, 0.0F, 0.4F};
    builder.scene().materials.push_back(glass);
    for (int channel = 0; channel < 3; ++channel) {
        const double once = (1 - 0.4) * (1 - 0.4 + 0.4 * glass.baseColor[channel]);
        EXPECT_NEAR(meanVisibility(builder.scene(), kAbove, channel), once * once, 1e-4) << channel;
    }
}

/// A room with a ball, its light in the ceiling: no view can hold the walls.
scene::Scene roomScene() {
    SceneBuilder builder;
    builder.addBox({-3, 0, -3}, {3, 3, 3});
    builder.addSphere({1.6F, 2.4F, 0}, 0.35F);
    builder.material().doubleSided = true;
    return builder.scene();
}

double roomError(const std::string& outside) {
    ShadowSetup setup;
    setup.light = "rect:at=0,2.9,0;aim=0,0,0;up=0,0,1;size=0.6x0.6;radiance=10";
    setup.eye = {-2.5, 1.5, 2.5};
    setup.target = {1, 1, -1};
    setup.fovDegrees = 80;
    setup.technique = "raytrace";
    const auto truth = runShadows(roomScene(), setup).visibility;
    setup.technique = "vwss";
    setup.settings = {{"vwss.outside", outside}, {"vwss.cull", "none"}};
    const auto run = runShadows(roomScene(), setup);
    EXPECT_GT(run.counts.outsideFov, 1000U);
    return rmse(run, truth);
}

TEST(RaytraceTest, ReceiversOutsideOfTheViewsAreTraced) {
    const double traced = roomError("raytrace"), lit = roomError("lit");
    std::printf("[ RMSE     ] room with a light in its ceiling: outside traced %.4f, lit %.4f\n",
                traced, lit);
    EXPECT_LT(traced, 0.03);
    EXPECT_GT(lit, 2 * traced);  // else the test shows nothing
}

TEST(RaytraceTest, WithoutCastersAllIsLit) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    EXPECT_EQ(meanVisibility(builder.scene(), kAbove), 1);
}

}  // namespace
}  // namespace penumbra::tests
