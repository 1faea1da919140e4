// SPDX-License-Identifier: MIT
// Multi-view soft shadows: their samples, their maps, their error against rays to the same samples,
// and what the default bias does to surfaces and contacts.
#include "host/visibility/mvss.h"

#include <algorithm>
#include <cmath>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

const char* const kSquare = "rect:at=0.8,4,0.4;aim=0,0,0;up=0,0,1;size=1.2x0.9;radiance=10";
const char* const kDisk = "disk:at=0.8,4,0.4;aim=0,0,0;up=0,0,1;radius=0.5;radiance=10";

ShadowSetup setupOf(const std::string& technique, const char* light = kSquare) {
    ShadowSetup setup;
    setup.technique = technique;
    setup.light = light;
    setup.eye = {0, 3, 4};
    setup.samples = "28";
    setup.pattern = scene::Pattern::poisson;
    return setup;
}

scene::Scene solids(bool floorCasts = false) {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, floorCasts);
    builder.addSphere({-0.7F, 0.8F, 0.2F}, 0.5F, 48, 64);
    builder.addBox({0.4F, 0.3F, -0.6F}, {1.0F, 0.9F, 0.1F});
    return builder.scene();
}

TEST(MvssTest, ItsSamplesAreThoseOfThePoissonPatternWithItsOwnCountAndSeed) {
    for (const char* shape : {kSquare, kDisk})
        for (const int seed : {0, 7}) {
            auto setup = setupOf("none", shape);
            setup.seed = static_cast<std::uint32_t>(seed);
            const auto poisson = runShadows(solids(), setup).light;
            ASSERT_EQ(poisson.samples.size(), 28U);
            setup.samples = "64";
            setup.pattern = scene::Pattern::hammersley;
            setup.seed = 3;
            const auto other = runShadows(solids(), setup).light;
            EXPECT_EQ(visibility::mvssLight(other, 28, seed).samples, poisson.samples);
        }
}

TEST(MvssTest, WithoutBiasItsMapsAreThoseOfMvrWithThePoissonPattern) {
    for (const char* shape : {kSquare, kDisk}) {
        auto setup = setupOf("mvr", shape);
        setup.keepMaps = true;
        setup.seed = 5;
        setup.settings = {{"mvr.resolution", "512"}};
        const auto mvr = runShadows(solids(), setup);
        setup.technique = "mvss";
        setup.samples = "3";  // says nothing here
        setup.pattern = scene::Pattern::hammersley;
        setup.settings = {{"mvss.seed", "5"}, {"mvss.constantBias", "0"}, {"mvss.slopeBias", "0"}};
        const auto mvss = runShadows(solids(), setup);
        EXPECT_EQ(mvss.maps.views, 28);
        EXPECT_EQ(mvss.maps.size, 512);
        EXPECT_TRUE(mvss.maps.depths == mvr.maps.depths) << shape;
        setup.settings["mvss.seed"] = "6";
        EXPECT_FALSE(runShadows(solids(), setup).maps.depths == mvr.maps.depths);
    }
}

TEST(MvssTest, VisibilityComesNearToThatOfRaysToTheSameSamples) {
    for (const char* shape : {kSquare, kDisk}) {
        const auto rays = runShadows(solids(), setupOf("raytrace", shape));
        std::vector<double> errors;
        for (const char* resolution : {"256", "512", "1024"}) {
            auto setup = setupOf("mvss", shape);
            setup.settings["mvss.resolution"] = resolution;
            errors.push_back(rmse(runShadows(solids(), setup), rays.visibility));
        }
        std::printf("[ RMSE     ] mvss with 28 maps of 256, 512, 1024: %.4f %.4f %.4f\n", errors[0],
                    errors[1], errors[2]);
        EXPECT_LT(errors[1], 0.02);
        EXPECT_LT(errors[1], 0.85 * errors[0]);
        EXPECT_LT(errors[2], 0.95 * errors[1]);
        // Other samples are farther away than the technique's own error
        auto other = setupOf("raytrace", shape);
        other.seed = 1;
        EXPECT_GT(rmse(rays, runShadows(solids(), other).visibility), errors[1]);
    }
}

/// Largest and mean visibility that a run lacks against rays, over tested pixels.
struct Acne {
    double mean = 0, share = 0;  ///< share: of pixels that lack more than a tenth
};
Acne acne(const scene::Scene& scene, ShadowSetup setup) {
    const auto run = runShadows(scene, setup);
    setup.technique = "raytrace";
    setup.settings.clear();
    const auto rays = runShadows(scene, setup);
    Acne result;
    double tested = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        const double lack =
            std::max(0.0, static_cast<double>(rays.visibility[i] - run.visibility[i]));
        ++tested;
        result.mean += lack;
        result.share += lack > 0.1;
    }
    EXPECT_GT(tested, 1000);
    return {result.mean / tested, result.share / tested};
}

TEST(MvssTest, TheDefaultBiasKeepsFlatAndTiltedReceiversFreeOfAcne) {
    for (const double degrees : {0.0, 30.0, 55.0}) {
        const auto c = static_cast<float>(std::cos(degrees * M_PI / 180)),
                   s = static_cast<float>(std::sin(degrees * M_PI / 180));
        SceneBuilder builder;
        builder.addQuad({-1, -s, c}, {2, 0, 0}, {0, 2 * s, -2 * c});
        auto setup = setupOf("mvss");
        EXPECT_EQ(acne(builder.scene(), setup).mean, 0) << degrees;
        setup.settings = {{"mvss.constantBias", "0"}, {"mvss.slopeBias", "0"}};
        EXPECT_GT(acne(builder.scene(), setup).share, 0.2) << degrees;  // what it keeps away
    }
}

TEST(MvssTest, TheDefaultBiasKeepsASphereNearlyFreeOfAcne) {
    SceneBuilder builder;
    builder.addSphere({0, 0, 0}, 1, 96, 128);
    auto setup = setupOf("mvss");
    const auto biased = acne(builder.scene(), setup);
    setup.settings = {{"mvss.constantBias", "0"}, {"mvss.slopeBias", "0"}};
    const auto plain = acne(builder.scene(), setup);
    std::printf(
        "[ ACNE     ] sphere: %.4f lacking, in %.1f %% of pixels; without bias %.4f, %.1f %%\n",
        biased.mean, 100 * biased.share, plain.mean, 100 * plain.share);
    EXPECT_LT(biased.mean, 0.005);
    EXPECT_LT(biased.share, 0.01);
    EXPECT_GT(plain.share, 0.1);
}

TEST(MvssTest, TheShadowOfABoxOnTheFloorBeginsAtTheBox) {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
    builder.addBox({-0.5F, 0, -0.5F}, {0.5F, 0.8F, 0.5F});
    auto setup = setupOf("mvss", "rect:at=3,4,-2;aim=0,0,0;up=0,1,0;size=1x1;radiance=10");
    setup.eye = {-2.5, 2, 2};  // sees the shadowed sides
    const auto run = runShadows(builder.scene(), setup);
    setup.technique = "raytrace";
    const auto rays = runShadows(builder.scene(), setup);
    std::size_t near = 0, detached = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const auto p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
        if (!run.tested(i) || std::abs(p.y) > 1e-3 || rays.visibility[i] > 0) continue;
        const double away = std::max(std::abs(p.x), std::abs(p.z)) - 0.5;
        if (away > 0.05) continue;
        ++near;
        detached += run.visibility[i] > 0.1F;
    }
    ASSERT_GT(near, 20U);
    EXPECT_LE(detached, near / 50) << "of " << near;
}

}  // namespace
}  // namespace penumbra::tests
