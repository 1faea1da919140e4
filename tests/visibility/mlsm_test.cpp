// SPDX-License-Identifier: MIT
// What the technique makes of layers, overlaps, colours, long lights and resolutions, against rays.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"
#include "tests/support/textured_scene.h"

namespace penumbra::tests {
namespace {

ShadowSetup mlsmSetup() {
    ShadowSetup setup;
    setup.technique = "mlsm";
    setup.light = "rect:at=0,6,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10";
    setup.eye = {0, 3, 4};
    setup.width = 120;
    setup.height = 90;
    setup.samples = "256";
    return setup;
}

ShadowRun runWith(const scene::Scene& scene, ShadowSetup setup, const std::string& technique,
                  const SettingValues& settings = {}) {
    setup.technique = technique;
    setup.settings = settings;
    return runShadows(scene, setup);
}

void addFloor(SceneBuilder& builder) {
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
}

glm::dvec3 placeOf(const ShadowRun& run, std::size_t pixel) {
    return glm::dvec3(run.vectorAt(GB_POSITION, pixel)) + run.bounds.centre();
}

/// A small blocker near to the light over a wide one near to the floor, which hides all below it.
scene::Scene layers() {
    SceneBuilder builder;
    addFloor(builder);
    builder.addQuad({-1.5F, 0.4F, 1.2F}, {3, 0, 0}, {0, 0, -2.4F});
    builder.addQuad({-0.25F, 4.2F, 0.3F}, {0.6F, 0, 0}, {0, 0.2F, -0.5F});
    builder.addQuad({0.1F, 2.4F, 0.5F}, {0.9F, 0.3F, 0}, {0, 0, -0.8F});
    return builder.scene();
}

/// Largest visibility where rays find none, away from edges.
double leakOf(const ShadowRun& run, const ShadowRun& rays) {
    double most = 0;
    std::size_t hidden = 0;
    const auto at = [&](int x, int y) { return static_cast<std::size_t>(y * run.width + x); };
    for (int y = 2; y + 2 < run.height; ++y)
        for (int x = 2; x + 2 < run.width; ++x) {
            bool dark = true;
            for (int k = 0; k < 25 && dark; ++k) {
                const auto other = at(x + k % 5 - 2, y + k / 5 - 2);
                dark = run.tested(other) && rays.visibility[other] == 0;
            }
            if (!dark) continue;
            ++hidden;
            most = std::max(most, static_cast<double>(run.visibility[at(x, y)]));
        }
    EXPECT_GT(hidden, 300U);
    return most;
}

TEST(MlsmTest, WhatLayersHideStaysHiddenWhereOneMapLeaks) {
    auto setup = mlsmSetup();
    setup.eye = {0, 0.35, 3.2};
    setup.target = {0, 0.1, 0};
    const auto rays = runWith(layers(), setup, "raytrace");
    const double mlsm = leakOf(runWith(layers(), setup, "mlsm"), rays);
    const double essm = leakOf(runWith(layers(), setup, "essm"), rays);
    const double pcss = leakOf(runWith(layers(), setup, "pcss"), rays);
    std::printf("[ LEAK     ] mlsm %.5f, essm %.5f, pcss %.5f\n", mlsm, essm, pcss);
    EXPECT_LT(mlsm, 1.0 / 255);
    EXPECT_GT(essm, 0.02);
    EXPECT_GT(pcss, 0.02);
}

TEST(MlsmTest, AWideSheetHidesAllBelowItHoweverItLeans) {
    // Its filter size changes across it: the levels' shares must still add up
    for (const float lean : {0.0F, 0.3F, 0.6F, 1.0F})
        for (const char* accumulate : {"add", "multiply"}) {
            SceneBuilder builder;
            addFloor(builder);
            builder.addQuad({-4, 2 - 3 * lean, 4}, {8, 0, 0}, {0, 6 * lean, -8});
            auto setup = mlsmSetup();
            setup.light = "rect:at=0,8,0;aim=0,0,0;up=0,0,1;size=2x2;radiance=10;fov=100;near=2";
            setup.eye = {0, 0.3, 1.4};
            const auto run =
                runWith(builder.scene(), setup, "mlsm", {{"mlsm.accumulateLookup", accumulate}});
            const auto rays = runWith(builder.scene(), setup, "raytrace");
            double most = 0;
            std::size_t tested = 0;
            for (std::size_t i = 0; i < run.pixels(); ++i) {
                const auto place = placeOf(run, i);
                if (!run.tested(i) || place.y > 0.01 || rays.visibility[i] > 0) continue;
                ++tested;
                most = std::max(most, static_cast<double>(run.visibility[i]));
            }
            std::printf("[ LEAN     ] %.1f %s: %zu pixels, at most %.4f\n", lean, accumulate,
                        tested, most);
            EXPECT_GT(tested, 500U);
            EXPECT_LT(most, 1.0 / 255) << lean << " " << accumulate;
        }
}

TEST(MlsmTest, PermutedTrianglesAndEitherBuildChangeNoByte) {
    auto scene =
        texturedScene(6, 60, {Surface::opaque, Surface::maskSmooth, Surface::blendTexture});
    auto setup = mlsmSetup();
    setup.light = kTexturedLight;
    const auto first = runWith(scene, setup, "mlsm");
    const auto linked = runWith(scene, setup, "mlsm", {{"mlsm.build", "list"}});
    EXPECT_EQ(first.visibility, linked.visibility);
    std::mt19937 random(5);
    for (auto& mesh : scene.meshes)
        for (auto& p : mesh.primitives)
            for (std::size_t t = p.indices.size() / 3 - 1; t > 0; --t) {
                const std::size_t other = random() % (t + 1);
                for (std::size_t c = 0; c < 3; ++c)
                    std::swap(p.indices[3 * t + c], p.indices[3 * other + c]);
            }
    const auto second = runWith(scene, setup, "mlsm");
    // Receivers alone may change sides at edges that two triangles share
    EXPECT_EQ(first.visibility, second.visibility);
}

TEST(MlsmTest, TheShadowOfAnEdgeIsAsWideAsParallelPlanesHaveIt) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addQuad({-3, 1.5F, 2}, {3, 0, 0}, {0, 0, -4});
    auto setup = mlsmSetup();
    setup.light = "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10;fov=70;near=1.5";
    setup.eye = {0.3, 0.9, 2.4};
    // Magnified texels of a pyramid are coarser than the penumbra: [MLSM] figure 6
    for (const auto& [stackFrom, limit] : {std::pair("0", 0.08), std::pair("128", 0.02)}) {
        const auto run = runWith(builder.scene(), setup, "mlsm", {{"mlsm.stackFrom", stackFrom}});
        double squares = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < run.pixels(); ++i) {
            const auto p = placeOf(run, i);
            if (!run.tested(i) || std::abs(p.y) > 1e-3) continue;
            // A square light: visibility grows linearly over size (zr - zb) / zb = 0.6 m
            const double truth = std::clamp(0.5 + p.x / 0.6, 0.0, 1.0);
            squares += std::pow(truth - run.visibility[i], 2);
            ++count;
        }
        const double error = std::sqrt(squares / static_cast<double>(count));
        std::printf("[ RMSE     ] edge, stack from %s: %.4f\n", stackFrom, error);
        EXPECT_LT(error, limit);
    }
}

TEST(MlsmTest, AnOccluderAcrossManyLevelsHasNoSteps) {
    // A thin sheet from the floor up to the light, seen from the side: [MLSM] figure 14
    SceneBuilder builder;
    addFloor(builder);
    builder.addQuad({-0.25F, 0, -0.5F}, {0.5F, 0, 0}, {0, 3, 0.2F});
    auto setup = mlsmSetup();
    setup.light = "rect:at=0,5,3;aim=0,0,-0.5;up=0,1,0;size=1x1;radiance=10";
    setup.eye = {2.5, 3.5, 0.5};
    setup.target = {0, 0, -0.8};
    const auto rays = runWith(builder.scene(), setup, "raytrace");
    const auto run = runWith(builder.scene(), setup, "mlsm");
    std::printf("[ RMSE     ] across levels: %.4f\n", rmse(run, rays.visibility));
    EXPECT_LT(rmse(run, rays.visibility), 0.05);
    // Where rays change little from pixel to pixel, so does the lookup
    double worst = 0;
    std::size_t smooth = 0;
    for (std::size_t i = 4; i + 4 < run.pixels(); ++i) {
        double truth = 0;
        bool tested = true;
        for (std::size_t k = i - 4; k < i + 4; ++k) {
            truth = std::max(
                truth, std::abs(static_cast<double>(rays.visibility[k]) - rays.visibility[k + 1]));
            tested &= run.tested(k) && placeOf(run, k).y < 1e-3 && placeOf(run, k).z < -0.65;
        }
        if (!tested || truth > 0.05) continue;
        smooth += run.visibility[i] > 0.02F && run.visibility[i] < 0.98F;
        worst = std::max(worst,
                         std::abs(static_cast<double>(run.visibility[i]) - run.visibility[i + 1]));
    }
    std::printf("[ STEP     ] at most %.3f in %zu pixels of penumbra\n", worst, smooth);
    EXPECT_GT(smooth, 50U);
    EXPECT_LT(worst, 0.08);
}

TEST(MlsmTest, OverlappingOccludersAddUpOrMultiply) {
    // Two sheets whose edges lie above one another: [MLSM] figure 15
    SceneBuilder builder;
    addFloor(builder);
    builder.addQuad({-3, 1, 2}, {3, 0, 0}, {0, 0, -4});
    builder.addQuad({-3, 3, 2}, {3, 0, 0}, {0, 0, -4});
    auto setup = mlsmSetup();
    setup.eye = {2.4, 0.8, 0};  // under the sheets
    for (const bool multiply : {false, true}) {
        const auto run = runWith(builder.scene(), setup, "mlsm",
                                 {{"mlsm.accumulateLookup", multiply ? "multiply" : "add"}});
        double squares = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < run.pixels(); ++i) {
            const auto p = placeOf(run, i);
            if (!run.tested(i) || std::abs(p.x) > 0.6 || std::abs(p.z) > 0.8 || p.y > 1e-3)
                continue;
            // Penumbrae of a square light of 1 m: 0.2 m and 1 m
            const double low = std::clamp(0.5 + p.x / 0.2, 0.0, 1.0);
            const double high = std::clamp(0.5 + p.x, 0.0, 1.0);
            const double expected = multiply ? low * high : std::max(low + high - 1, 0.0);
            squares += std::pow(run.visibility[i] - expected, 2);
            ++count;
        }
        const double error = std::sqrt(squares / static_cast<double>(count));
        std::printf("[ RMSE     ] overlap, %s: %.4f\n", multiply ? "multiply" : "add", error);
        EXPECT_GT(count, 200U);
        EXPECT_LT(error, 0.055);
    }
}

TEST(MlsmTest, LongLightsDisksAndHalfResolutionAreCloseToRays) {
    SceneBuilder builder;
    addFloor(builder);
    builder.addSphere({-0.7F, 0.8F, 0.2F}, 0.5F, 24, 32);
    builder.addBox({0.4F, 0.5F, -0.6F}, {1.0F, 0.9F, 0.1F});
    const struct {
        const char *name, *light;
        SettingValues settings;
        double limit;
    } cases[] = {{"square", "rect:at=0.5,5,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10", {}, 0.035},
                 {"wide", "rect:at=0.5,5,0;aim=0,0,0;up=0,0,1;size=2x0.5;radiance=10", {}, 0.045},
                 {"high", "rect:at=0.5,5,0;aim=0,0,0;up=0,0,1;size=0.4x1.6;radiance=10", {}, 0.045},
                 {"disk", "disk:at=0.5,5,0;aim=0,0,0;radius=0.5;radiance=10", {}, 0.035},
                 {"sphere", "sphere:at=0.5,5,0;radius=0.5;radiance=10", {}, 0.035},
                 {"half",
                  "rect:at=0.5,5,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10",
                  {{"mlsm.halfResolution", "true"}},
                  0.06},
                 {"antialias",
                  "rect:at=0.5,5,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10",
                  {{"mlsm.antialias", "true"}},
                  0.035}};
    for (const auto& c : cases) {
        auto setup = mlsmSetup();
        setup.light = c.light;
        const auto rays = runWith(builder.scene(), setup, "raytrace");
        const auto run = runWith(builder.scene(), setup, "mlsm", c.settings);
        std::printf("[ RMSE     ] %s: %.4f\n", c.name, rmse(run, rays.visibility));
        EXPECT_LT(rmse(run, rays.visibility), c.limit) << c.name;
    }
}

TEST(MlsmTest, AntialiasingFiltersOverThePixelEvenAtAPointLight) {
    // A comb of bars finer than pixels: its mean, not its aliases
    SceneBuilder builder;
    addFloor(builder);
    for (int i = 0; i < 60; ++i)
        builder.addQuad({-1.2F + 0.04F * static_cast<float>(i), 1, 1.5F}, {0.02F, 0, 0},
                        {0, 0, -3});
    auto setup = mlsmSetup();
    setup.light = "rect:at=0,6,0;aim=0,0,0;up=0,0,1;size=0.2x0.2;radiance=10";
    setup.eye = {0, 0.9, 4};
    setup.width = 32;
    setup.height = 24;
    const auto spreadOf = [&](const char* antialias) {
        const auto run = runWith(builder.scene(), setup, "mlsm", {{"mlsm.antialias", antialias}});
        double sum = 0, squares = 0;
        std::size_t count = 0;
        for (std::size_t i = 0; i < run.pixels(); ++i) {
            const auto p = placeOf(run, i);
            if (!run.tested(i) || p.y > 1e-3 || std::abs(p.x) > 0.8 || std::abs(p.z) > 1) continue;
            sum += run.visibility[i];
            squares += run.visibility[i] * run.visibility[i];
            ++count;
        }
        const double mean = sum / static_cast<double>(count);
        EXPECT_NEAR(mean, 0.5, 0.08) << antialias;
        return std::sqrt(squares / static_cast<double>(count) - mean * mean);
    };
    const double without = spreadOf("false"), with = spreadOf("true");
    std::printf("[ SPREAD   ] %.3f without, %.3f with\n", without, with);
    EXPECT_LT(with, 0.7 * without);
}

TEST(MlsmTest, ColouredPanesAndWhatStandsBehindThemAreThoseOfRays) {
    SceneBuilder builder;
    addFloor(builder);
    builder.addQuad({-1.5F, 2, 1}, {1.7F, 0, 0}, {0, 0, -2});
    builder.addQuad({-0.6F, 2.5F, 1}, {1.7F, 0, 0}, {0, 0, -2});
    builder.addSphere({-0.2F, 0.6F, 0.1F}, 0.3F);
    auto& scene = builder.scene();
    for (int pane = 0; pane < 2; ++pane) {
        scene::Material glass = scene.materials[0];
        glass.baseColor = pane ? glm::vec4(0.2F, 0.9F, 0.3F, 1) : glm::vec4(0.9F, 0.3F, 0.2F, 1);
        glass.transmission = 0.9F;
        scene.meshes[static_cast<std::size_t>(pane) + 1].primitives[0].material =
            static_cast<int>(scene.materials.size());
        scene.materials.push_back(glass);
    }
    const auto setup = mlsmSetup();
    const auto rays = runWith(scene, setup, "raytrace");
    const auto run = runWith(scene, setup, "mlsm");
    ASSERT_EQ(run.visibility.size(), 3 * run.stride);
    double squares = 0, colour = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i)
        for (std::size_t c = 0; c < 3 && run.tested(i); ++c, ++count) {
            squares += std::pow(
                run.visibility[c * run.stride + i] - rays.visibility[c * run.stride + i], 2);
            colour = std::max(
                colour,
                static_cast<double>(std::abs(run.visibility[i] - run.visibility[run.stride + i])));
        }
    const double error = std::sqrt(squares / static_cast<double>(count));
    std::printf("[ RMSE     ] coloured panes: %.4f\n", error);
    EXPECT_LT(error, 0.03);
    EXPECT_GT(colour, 0.4);
}

TEST(MlsmTest, AllLayersAndAllLevelsComeCloserToRays) {
    SceneBuilder builder;
    addFloor(builder);
    builder.addQuad({-0.2F, 0.3F, 0.8F}, {0.4F, 0, 0}, {0, 0, -1.6F});
    builder.addQuad({-0.15F, 3, 1}, {0.3F, 0, 0}, {0, 0, -2});
    auto setup = mlsmSetup();
    setup.eye = {1.6, 0.5, 0.8};  // the floor below the lower sheet
    const auto rays = runWith(builder.scene(), setup, "raytrace");
    const auto errorWith = [&](const SettingValues& settings) {
        return rmse(runWith(builder.scene(), setup, "mlsm", settings), rays.visibility);
    };
    const double one = errorWith({{"mlsm.layers", "1"}}), all = errorWith({});
    const double limited = errorWith({{"mlsm.maxLevel", "3"}});
    std::printf("[ RMSE     ] one layer %.4f, all %.4f, maxLevel 3 %.4f\n", one, all, limited);
    EXPECT_LT(all, 0.7 * one);
    EXPECT_LT(all, 0.8 * limited);
}

}  // namespace
}  // namespace penumbra::tests
