// SPDX-License-Identifier: MIT
// Occlusion masks bit by bit against a double-precision twin, and what masks must obey.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "host/visibility/light_grid.h"
#include "tests/reference/raster4d_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

const char* const kAbove = "rect:at=0.4,5,0.3;aim=0,0,0;up=0,0,1;size=2x1.4;radiance=10";

ShadowSetup maskSetup(const std::string& samples) {
    ShadowSetup setup;
    setup.technique = "raster4d";
    setup.samples = samples;
    setup.light = kAbove;
    setup.eye = {0, 3, 4};
    setup.width = 40;
    setup.height = 30;
    setup.keepMasks = true;
    return setup;
}

void addFloor(SceneBuilder& builder) {
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
}

/// Triangles of every kind about a floor: small, large, needles, degenerate ones, some through the
/// light's plane, some below the receivers.
scene::Scene tangle(unsigned seed, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-2, 2), high(0.02F, 5.6F), small(-0.3F, 0.3F);
    SceneBuilder builder;
    builder.material().doubleSided = true;
    addFloor(builder);
    std::vector<glm::vec3> corners;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 first{at(random), high(random), at(random)};
        const glm::vec3 b = first + glm::vec3{small(random), small(random), small(random)};
        const glm::vec3 c = first + glm::vec3{small(random), small(random), small(random)};
        const glm::vec3 far{at(random), high(random), at(random)};
        corners.push_back(first);
        corners.push_back(i % 10 == 1 ? far : b);
        corners.push_back(i % 10 == 2   ? first + 1e-4F * (c - first)  // a needle
                          : i % 10 == 3 ? b                            // no area
                                        : c);
    }
    std::vector<std::uint32_t> indices(corners.size());
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i);
    builder.addMesh(corners, indices);
    return builder.scene();
}

void expectTwin(const char* name, const scene::Scene& scene, const ShadowSetup& setup,
                std::size_t pixelStep = 1) {
    const auto result = compareMasks(runShadows(scene, setup), pixelStep);
    std::printf("[ BITS     ] %s: %zu, %zu hidden, %zu grazes, %zu wrong\n", name, result.bits,
                result.hidden, result.grazes, result.wrong);
    EXPECT_EQ(result.wrong, 0U) << name;
    EXPECT_GT(result.bits, 250U) << name;
    EXPECT_GT(result.hidden, result.bits / 50) << name;
    EXPECT_LT(result.hidden, result.bits) << name;
    EXPECT_LE(result.grazes, result.bits / 500 + 2) << name;
}

struct Samples {
    const char* name;
    const char* samples;
    scene::Pattern pattern;
    const char* light;
};

class Raster4dTwinTest : public testing::TestWithParam<Samples> {};

TEST_P(Raster4dTwinTest, EveryBitEqualsTheTwin) {
    auto setup = maskSetup(GetParam().samples);
    setup.pattern = GetParam().pattern;
    if (GetParam().light) setup.light = GetParam().light;
    expectTwin(GetParam().name, tangle(5, 120), setup, 3);
}

using scene::Pattern;
INSTANTIATE_TEST_SUITE_P(
    Samples, Raster4dTwinTest,
    testing::Values(Samples{"one", "1x1", Pattern::grid, nullptr},
                    Samples{"few", "5x3", Pattern::grid, nullptr},
                    Samples{"square", "8x8", Pattern::grid, nullptr},
                    Samples{"wide", "33x7", Pattern::grid, nullptr},
                    Samples{"tall", "3x50", Pattern::grid, nullptr},
                    Samples{"full", "32x32", Pattern::grid, nullptr},
                    Samples{"most", "64x64", Pattern::grid, nullptr},
                    Samples{"jittered", "16x16", Pattern::jittered, nullptr},
                    Samples{"hammersley", "128", Pattern::hammersley, nullptr},
                    Samples{"poisson", "90", Pattern::poisson, nullptr},
                    Samples{"disk", "20x20", Pattern::grid,
                            "disk:at=0.4,5,0.3;aim=0,0,0;up=0,0,1;radius=1;radiance=10"},
                    Samples{"jitteredDisk", "12x12", Pattern::jittered,
                            "disk:at=0.4,5,0.3;aim=0,0,0;up=0,0,1;radius=1;radiance=10"},
                    Samples{"sphere", "16x16", Pattern::grid,
                            "sphere:at=0.4,5,0.3;radius=0.8;radiance=10"},
                    Samples{"strip", "32x4", Pattern::grid,
                            "rect:at=0.4,5,0.3;aim=0.5,0,0.2;up=0.3,0,1;size=4x0.1;radiance=10"},
                    Samples{"point", "8x8", Pattern::grid,
                            "rect:at=0.4,5,0.3;aim=0,0,0;up=0,0,1;size=0x0;radiance=10"}),
    [](const auto& test) { return test.param.name; });

TEST(Raster4dTest, SolidsEqualTheTwinAtContact) {
    SceneBuilder builder;
    addFloor(builder);
    builder.addSphere({-0.7F, 0.5F, 0.2F}, 0.5F, 12, 20);
    builder.addBox({0.4F, 0, -0.6F}, {1.0F, 0.9F, 0.1F});
    expectTwin("solids", builder.scene(), maskSetup("16x16"), 2);
}

/// Visibility of all tested pixels is this.
void expectAll(const scene::Scene& scene, const ShadowSetup& setup, float visibility) {
    const auto run = runShadows(scene, setup);
    std::size_t tested = 0, other = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        tested += run.tested(i);
        other += run.tested(i) && run.visibility[i] != visibility;
    }
    EXPECT_GT(tested, 80U);
    EXPECT_EQ(other, 0U);
}

TEST(Raster4dTest, AClosedBoxHidesAllOfItsInsideHoweverItLies) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int turn = 0; turn < 12; ++turn) {
        SceneBuilder builder;
        builder.addQuad({-0.4F, 0, 0.4F}, {0.8F, 0, 0}, {0, 0, -0.8F}, false);
        builder.addSphere({0, 0, 0}, 1.2F, 7, 9);
        builder.addBox({-1, -1, -1}, {1, 1, 1});
        auto& scene = builder.scene();
        const glm::dvec3 axis{unit(random), unit(random), unit(random)};
        const double size = std::exp(3 * unit(random));
        for (std::size_t node = 1; node < scene.nodes.size(); ++node)
            scene.nodes[node].matrix = glm::rotate(glm::scale(glm::dmat4(1), glm::dvec3(size)),
                                                   3 * unit(random), glm::normalize(axis)) *
                                       scene.nodes[node].matrix;
        scene.nodes[0].matrix = glm::scale(glm::dmat4(1), glm::dvec3(size));
        auto setup = maskSetup("32x32");
        setup.light = fmt::format("rect:at=0,{},0;aim=0,0,0;up=0,0,1;size={}x{};radiance=10",
                                  5 * size, size, size);
        setup.eye = glm::dvec3(0.1, 0.4, 0.5) * size;
        setup.width = setup.height = 32;
        expectAll(scene, setup, 0);
    }
}

TEST(Raster4dTest, AFinelyCutSheetHasNoCracks) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addSphere({0, 0, 0}, 3.3F, 61, 127);
    for (const char* samples : {"32x32", "64x64", "7x50"}) {
        auto setup = maskSetup(samples);
        setup.eye = {0, 0.3, 3};
        setup.light = "rect:at=0,6,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10";
        expectAll(builder.scene(), setup, 0);
    }
}

std::size_t differentBits(const ShadowRun& a, const ShadowRun& b) {
    std::size_t count = 0;
    EXPECT_EQ(a.masks.bits.size(), b.masks.bits.size());
    for (std::size_t i = 0; i < std::min(a.masks.bits.size(), b.masks.bits.size()); ++i)
        count += static_cast<std::size_t>(__builtin_popcount(a.masks.bits[i] ^ b.masks.bits[i]));
    return count;
}

ShadowRun scaled(double factor) {
    auto scene = tangle(5, 120);
    for (auto& node : scene.nodes)
        node.matrix = glm::scale(glm::dmat4(1), glm::dvec3(factor)) * node.matrix;
    auto setup = maskSetup("16x16");
    setup.light = fmt::format("rect:at={},{},{};aim=0,0,0;up=0,0,1;size={}x{};radiance=10",
                              0.4 * factor, 5 * factor, 0.3 * factor, 2 * factor, 1.4 * factor);
    setup.eye = glm::dvec3(0, 3, 4) * factor;
    return runShadows(scene, setup);
}

TEST(Raster4dTest, ScalingByPowersOfTwoChangesNoBit) {
    const auto one = scaled(1);
    EXPECT_EQ(differentBits(one, scaled(1024)), 0U);
    EXPECT_EQ(differentBits(one, scaled(1.0 / 1024)), 0U);
}

TEST(Raster4dTest, MovingTheSceneFarAwayChangesBitsAtGrazesOnly) {
    const auto at = [](const glm::dvec3& shift) {
        auto scene = tangle(5, 120);
        for (auto& node : scene.nodes)
            node.matrix = glm::translate(glm::dmat4(1), shift) * node.matrix;
        auto setup = maskSetup("16x16");
        setup.light =
            fmt::format("rect:at={},{},{};aim={},{},{};up=0,0,1;size=2x1.4;radiance=10",
                        0.4 + shift.x, 5 + shift.y, 0.3 + shift.z, shift.x, shift.y, shift.z);
        setup.eye = glm::dvec3(0, 3, 4) + shift;
        setup.target = shift;
        return runShadows(scene, setup);
    };
    const auto here = at({0, 0, 0}), there = at({1e4, -2e4, 5e3});
    const auto bits = here.masks.bits.size() * 16;
    EXPECT_LE(differentBits(here, there), bits / 2000);
    EXPECT_EQ(compareMasks(there, 3).wrong, 0U);
}

TEST(Raster4dTest, TheOrderOfTrianglesChangesNoBit) {
    auto scene = tangle(5, 300);
    const auto setup = maskSetup("32x32");
    const auto first = runShadows(scene, setup);
    auto& indices = scene.meshes[1].primitives[0].indices;
    std::mt19937 random(3);
    for (std::size_t t = indices.size() / 3 - 1; t > 0; --t) {
        const std::size_t other = random() % (t + 1);
        for (std::size_t c = 0; c < 3; ++c) std::swap(indices[3 * t + c], indices[3 * other + c]);
    }
    EXPECT_EQ(differentBits(first, runShadows(scene, setup)), 0U);
}

/// The paper's grid with settings of its own; a short list makes it grow.
class Raster4dGridTest : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(Raster4dGridTest, TheBitsAreThoseOfTheBins) {
    for (const char* samples : {"40x9"}) {
        auto setup = maskSetup(samples);
        const auto scene = tangle(11, 400);
        const auto bins = runShadows(scene, setup);
        setup.settings["raster4d.method"] = "grid";
        for (std::size_t i = 0; i + 1 < GetParam().size(); i += 2)
            setup.settings["raster4d." + GetParam()[i]] = GetParam()[i + 1];
        const auto grid = runShadows(scene, setup);
        EXPECT_EQ(differentBits(bins, grid), 0U);
        EXPECT_EQ(bins.visibility, grid.visibility);
    }
}

using Settings = std::vector<std::string>;
INSTANTIATE_TEST_SUITE_P(Switches, Raster4dGridTest,
                         testing::Values(Settings{}, Settings{"grid", "8"}, Settings{"grid", "512"},
                                         Settings{"onePixel", "false"}, Settings{"reject", "false"},
                                         Settings{"rowAtOnce", "false"},
                                         Settings{"onePixel", "false", "reject", "false",
                                                  "rowAtOnce", "false", "grid", "32"}));

TEST(Raster4dSlowTest, ListsOfAnyLengthLoseNothing) {
    SceneBuilder builder;
    addFloor(builder);
    builder.addSphere({0, 1.5F, 0}, 0.9F, 330, 480);  // 316,000 triangles in one cone
    builder.addSphere({0.2F, 0.5F, 0.1F}, 0.3F, 100, 100);
    auto setup = maskSetup("32x32");
    setup.light = "rect:at=0.4,3.2,0.3;aim=0,0,0;up=0,0,1;size=2.5x2.5;radiance=10";
    const auto masks = runShadows(builder.scene(), setup);
    setup.settings["raster4d.method"] = "grid";
    EXPECT_EQ(differentBits(masks, runShadows(builder.scene(), setup)), 0U);
    setup.technique = "raytrace";
    const auto rays = runShadows(builder.scene(), setup);
    double difference = 0;
    for (std::size_t i = 0; i < masks.pixels(); ++i)
        if (masks.tested(i)) difference += std::abs(masks.visibility[i] - rays.visibility[i]);
    EXPECT_LT(difference, 20.0 / 1024);  // samples, of all pixels
}

/// A floor under a sheet whose opacity a material decides.
scene::Scene sheetScene(scene::AlphaMode mode, float alpha) {
    SceneBuilder builder;
    addFloor(builder);
    const int node = builder.addQuad({-3, 2, 3}, {6, 0, 0}, {0, 0, -6});
    auto& scene = builder.scene();
    scene::Material material = scene.materials[0];
    material.alphaMode = mode;
    material.baseColor.a = alpha;
    material.doubleSided = true;
    scene.materials.push_back(material);
    scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].mesh)]
        .primitives[0]
        .material = 1;
    return scene;
}

/// Below the sheet, which the camera would see else.
ShadowSetup belowSheet(const std::string& samples) {
    auto setup = maskSetup(samples);
    setup.eye = {0, 1, 4};
    return setup;
}

TEST(Raster4dTest, ABlendedSheetBlocksItsShareOfTheSamples) {
    for (const float alpha : {0.25F, 0.5F, 0.8F})
        expectAll(sheetScene(scene::AlphaMode::blend, alpha), belowSheet("10x10"),
                  (100 - std::round(alpha * 100)) / 100);
}

TEST(Raster4dTest, AnAlphaTestPassesOrBlocks) {
    expectAll(sheetScene(scene::AlphaMode::mask, 0.4F), belowSheet("8x8"), 1);
    expectAll(sheetScene(scene::AlphaMode::mask, 0.6F), belowSheet("8x8"), 0);
}

TEST(LightGridTest, EverySampleHasACellOfItsOwn) {
    scene::AreaLight light;
    light.width = 2;
    light.height = 3;
    scene::SampleChoice choice;
    for (const int count : {1, 2, 7, 64, 100, 256}) {
        for (const auto pattern : {Pattern::hammersley, Pattern::poisson, Pattern::jittered}) {
            choice.count = count;
            choice.pattern = pattern;
            scene::placeSamples(choice, light);
            const auto grid = visibility::fitLightGrid(light);
            std::vector<int> seen;
            for (std::size_t cell = 0; cell < grid.sample.size(); ++cell) {
                if (grid.sample[cell] < 0) continue;
                seen.push_back(grid.sample[cell]);
                const auto& s = light.samples[static_cast<std::size_t>(grid.sample[cell])];
                EXPECT_NEAR(grid.position[cell].x * grid.cellWidth,
                            s.x + (light.width - grid.cellWidth) / 2, 1e-5);
                EXPECT_NEAR(grid.position[cell].y * grid.cellHeight,
                            s.y + (light.height - grid.cellHeight) / 2, 1e-5);
            }
            std::sort(seen.begin(), seen.end());
            ASSERT_EQ(seen.size(), static_cast<std::size_t>(count));
            for (int i = 0; i < count; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
        }
    }
}

TEST(LightGridTest, GridsAreTakenAsTheyAreAndPowersOfTwoGetACellEach) {
    scene::AreaLight light;
    const auto sizeOf = [&](const std::string& samples, Pattern pattern) {
        scene::SampleChoice choice;
        choice.pattern = pattern;
        scene::placeSamples(scene::parseSampleCount(samples, choice), light);
        const auto grid = visibility::fitLightGrid(light);
        return fmt::format("{}x{}{}", grid.columns, grid.rows, grid.centred ? "" : " off centre");
    };
    EXPECT_EQ(sizeOf("9x5", Pattern::grid), "9x5");
    EXPECT_EQ(sizeOf("64x64", Pattern::grid), "64x64");
    EXPECT_EQ(sizeOf("256", Pattern::hammersley), "16x16 off centre");
    EXPECT_EQ(sizeOf("12x12", Pattern::jittered), "12x12 off centre");
    EXPECT_THROW(sizeOf("65x2", Pattern::grid), Error);
    EXPECT_THROW(sizeOf("4096", Pattern::poisson), Error);
}

}  // namespace
}  // namespace penumbra::tests
