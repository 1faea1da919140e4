// SPDX-License-Identifier: MIT
// Occlusion masks bit by bit against Embree, at the size that [4DR] uses. Bits that differ must be
// grazes in double precision.
#include <cstdio>

#include "host/scene/builtin.h"
#include "host/scene/gltf_loader.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/embree_scene.h"
#include "tests/reference/raster4d_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

void expectEmbree(const char* name, const ShadowRun& run, double share) {
    const EmbreeScene embree(run.casters);
    const auto points = run.samplePoints();
    const double tolerance = 1e-6 * run.bounds.radius();
    std::size_t bits = 0, different = 0, wrong = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        const glm::vec3 origin = run.shadowOrigin(i), normal = run.vectorAt(GB_GEOMETRIC, i);
        for (int row = 0; row < run.masks.rows; ++row)
            for (int column = 0; column < run.masks.columns; ++column) {
                const auto cell = static_cast<std::size_t>(row * run.masks.columns + column);
                const auto& point = points[static_cast<std::size_t>(run.masks.samples[cell])];
                const float height = glm::dot(point - origin, normal);
                const bool truth = height <= 0 || embree.occluded(origin, point);
                ++bits;
                const bool hidden = maskBit(run, i, row, column);
                if (hidden == truth) continue;
                ++different;
                const auto verdict = segmentVerdict(run.casters, origin, point, tolerance);
                wrong += std::abs(height) > tolerance && verdict != Verdict::graze &&
                         hidden != (verdict == Verdict::hidden);
            }
    }
    std::printf("[ BITS     ] %s: %zu of %zu differ from Embree (%.1e), %zu of them no graze\n",
                name, different, bits, static_cast<double>(different) / static_cast<double>(bits),
                wrong);
    EXPECT_GT(bits, 1000000U) << name;
    EXPECT_LE(static_cast<double>(different), share * static_cast<double>(bits) + 1) << name;
    EXPECT_EQ(wrong, 0U) << name;
}

ShadowSetup setupOf(int size, const char* samples) {
    ShadowSetup setup;
    setup.technique = "raster4d";
    setup.placedCamera = false;
    setup.samples = samples;
    setup.width = setup.height = size;
    setup.keepMasks = true;
    return setup;
}

TEST(Raster4dEmbree, TheBuiltinSceneAgreesBitByBit) {
    expectEmbree("built-in", runShadows(scene::loadBuiltinScene(), setupOf(160, "32x32")), 1e-6);
}

class Raster4dEmbreeAssets : public testing::TestWithParam<const char*> {};

TEST_P(Raster4dEmbreeAssets, AgreeBitByBit) {
    if (assetFolder().empty())
        GTEST_SKIP() << "the models are absent; set PENUMBRA_ASSETS to their folder";
    auto scene = scene::loadGltf(assetFolder() + "/" + GetParam());
    scene.cameras.clear();
    for (auto& m : scene.materials) m.alphaMode = scene::AlphaMode::opaque;  // as Embree sees them
    scene::addGround(scene, scene::clipBounds(scene, scene::chooseAnimations(scene, "")));
    auto setup = setupOf(160, "32x32");
    setup.seconds = 0.4;
    expectEmbree(GetParam(), runShadows(scene, setup), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(
    Models, Raster4dEmbreeAssets,
    testing::Values("Knight/Knight.glb", "RecursiveSkeletons/RecursiveSkeletons.glb",
                    "RobotPartsA/robot_parts_a.gltf",
                    "MetalRoughSpheresNoTextures/MetalRoughSpheresNoTextures.glb"));

}  // namespace
}  // namespace penumbra::tests
