// SPDX-License-Identifier: MIT
// Depth maps straight from triangles: all forms agree to the bit, and with rays in double.
#include "host/visibility/map_raster.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "tests/reference/map_raster_ref.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

ShadowSetup mapsSetup() {
    ShadowSetup setup;
    setup.technique = "mvr";
    setup.light = "rect:at=0.6,5,0.8;aim=0,0,0;size=1x0.7;fov=60;near=1.5";
    setup.eye = {1, 3, 4};
    setup.width = 61;
    setup.height = 37;
    setup.samples = "11";
    setup.keepMaps = true;
    setup.settings = {{"mvr.resolution", "96"}};
    return setup;
}

/// Triangles of all sizes: slivers, specks, and one as large as the map.
std::vector<glm::dvec3> soup(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-1.2, 1.2), extent(0.01, 0.4);
    std::vector<glm::dvec3> corners{{-1.5, 0.1, -1.2}, {1.6, 0.2, -1}, {0.1, -0.2, 1.7}};
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 centre{place(random), 0.8 * place(random) + 1, place(random)};
        const double size = extent(random) * extent(random) * 4;
        for (int c = 0; c < 3; ++c)
            corners.push_back(centre +
                              size * glm::dvec3{place(random), place(random), place(random)});
    }
    return corners;
}

scene::Scene soupScene(const std::vector<glm::dvec3>& corners) {
    SceneBuilder builder;
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
    for (const auto& c : corners) {
        indices.push_back(static_cast<std::uint32_t>(positions.size()));
        positions.emplace_back(c);
    }
    builder.addMesh(positions, indices);
    return builder.scene();
}

/// Closed solids, a masked leaf, a blended pane, a wall across the whole view, and a post that
/// reaches up past the light's near plane.
scene::Scene mixedScene() {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    builder.addSphere({0, 0.9F, 0}, 0.6F, 24, 32);
    const int leaf = builder.addQuad({-1, 1.8F, -0.3F}, {0.9F, 0, 0}, {0, 0.2F, 0.9F});
    const int pane = builder.addQuad({0.3F, 1.9F, -0.6F}, {0.9F, 0, 0}, {0, 0, 0.9F});
    builder.addMesh({{1.2F, 0, 0.2F}, {1.25F, 0, 0.2F}, {1.2F, 5.5F, 0.6F}}, {0, 1, 2});
    builder.addMesh({{-0.4F, 0.2F, 0.9F}, {0, 0.2F, 0.9F}, {0, 0.6F, 0.9F}}, {0, 1, 2},
                    glm::dmat4(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.2, 0, 0, 1));
    auto& scene = builder.scene();
    scene::Image checker;
    checker.width = checker.height = 8;
    for (int i = 0; i < 64; ++i)
        for (int c = 0; c < 4; ++c)
            checker.texels.push_back(static_cast<std::uint8_t>((i + i / 8) % 2 ? 255 : 40));
    scene.images.push_back(checker);
    for (const auto mode : {scene::AlphaMode::mask, scene::AlphaMode::blend}) {
        auto material = scene.materials[0];
        material.baseColorTexture.image = 0;
        material.alphaMode = mode;
        scene.materials.push_back(material);
    }
    const std::pair<int, int> uses[] = {{leaf, 1}, {pane, 2}};
    for (const auto& [node, material] : uses) {
        auto& p =
            scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].mesh)]
                .primitives[0];
        p.material = material;
        for (const auto& position : p.positions) p.uvs[0].emplace_back(position.x, position.z);
    }
    return scene;
}

bool sameMaps(const ShadowRun& a, const ShadowRun& b) {
    return a.maps.depths.size() == b.maps.depths.size() &&
           std::memcmp(a.maps.depths.data(), b.maps.depths.data(),
                       a.maps.depths.size() * sizeof(float)) == 0 &&
           a.visibility == b.visibility;
}

std::size_t covered(const ShadowRun& run) {
    return static_cast<std::size_t>(std::count_if(run.maps.depths.begin(), run.maps.depths.end(),
                                                  [](float d) { return d > 0; }));
}

TEST(MapRasterTest, EveryFormGivesTheSameMapsToTheBit) {
    for (const char* coverage : {"standard", "conservative"})
        for (const char* cull : {"auto", "back", "front", "none"})
            for (const char* bits : {"32", "16"}) {
                auto setup = mapsSetup();
                setup.settings["mvr.coverage"] = coverage;
                setup.settings["mvr.cull"] = cull;
                setup.settings["mvr.depthBits"] = bits;
                const auto full = runShadows(mixedScene(), setup);
                ASSERT_GT(covered(full), 10000U);
                for (const char* batch : {"1", "4"}) {
                    setup.settings["mvr.viewsPerBatch"] = batch;
                    EXPECT_TRUE(sameMaps(full, runShadows(mixedScene(), setup)))
                        << coverage << cull << bits << " in batches of " << batch;
                }
                setup.settings["mvr.form"] = "textbook";
                EXPECT_TRUE(sameMaps(full, runShadows(mixedScene(), setup)))
                    << coverage << cull << bits << " textbook";
            }
}

TEST(MapRasterTest, MapsHoldWhatRaysThroughTexelCentresMeet) {
    for (const unsigned seed : {1U, 2U, 3U}) {
        const auto corners = soup(300, seed);
        auto setup = mapsSetup();
        setup.settings["mvr.cull"] = "none";
        const auto run = runShadows(soupScene(corners), setup);
        const auto view =
            visibility::fitLightView(run.light, run.bounds, run.bounds.centre(), 96, 1);
        std::size_t compared = 0, wrong = 0;
        for (std::size_t sample = 0; sample < run.light.samples.size(); ++sample) {
            const auto twin = castMap(run.light, run.light.samples[sample], corners,
                                      view.params.focal, view.params.near, 96);
            for (std::size_t i = 0; i < twin.size(); ++i) {
                if (twin[i].margin < 0.01) continue;  // vertices snap to 1/256 texel
                ++compared;
                const double depth = run.maps.depths[sample * twin.size() + i];
                // Snapping moves a steep triangle's depth by its slope times 1/256 texel
                wrong += std::abs(depth - twin[i].depth) > 2e-3 ? 1 : 0;
            }
        }
        EXPECT_GT(compared, 50000U);
        EXPECT_LE(wrong, compared / 2000) << "seed " << seed;
    }
}

TEST(MapRasterTest, ConservativeCoverageHoldsTheStandardOneAndShrinksTowardsIt) {
    std::vector<double> excess;
    for (const char* resolution : {"64", "128", "256"}) {
        auto setup = mapsSetup();
        setup.settings["mvr.resolution"] = resolution;
        const auto standard = runShadows(mixedScene(), setup);
        setup.settings["mvr.coverage"] = "conservative";
        const auto conservative = runShadows(mixedScene(), setup);
        for (std::size_t i = 0; i < standard.maps.depths.size(); ++i)
            ASSERT_LE(standard.maps.depths[i] > 0, conservative.maps.depths[i] > 0);
        const auto size = static_cast<double>(standard.maps.depths.size());
        excess.push_back(static_cast<double>(covered(conservative) - covered(standard)) / size);
    }
    EXPECT_GT(excess[0], 0.005);
    EXPECT_LT(excess[1], 0.7 * excess[0]);
    EXPECT_LT(excess[2], 0.7 * excess[1]);
}

/// Mean of 1 - visibility over the floor: the shadow's area.
double shadowArea(const std::string& technique, const std::string& coverage, int resolution) {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> extent(0.1F, 0.25F);
    for (int i = 0; i < 49; ++i)  // faces across the light's axis, of many sizes and places
        builder.addQuad({-1.2F + 0.35F * static_cast<float>(i % 7) + 0.1F * extent(random), 1,
                         1.2F - 0.35F * static_cast<float>(i / 7) + 0.1F * extent(random)},
                        {extent(random), 0, 0}, {0, 0, -extent(random)});
    auto setup = mapsSetup();
    setup.light = "rect:at=0,5,0;aim=0,0,0;up=0,0,1;size=0.4x0.4;fov=50;near=2";
    setup.eye = {0, 0.95, 0.001};  // from below the faces straight down: the floor evenly sampled
    setup.fovDegrees = 120;
    setup.width = 200;
    setup.height = 200;
    setup.keepMaps = false;
    setup.technique = technique;
    setup.samples = "64";
    setup.settings = {{technique + ".resolution", std::to_string(resolution)},
                      {technique + ".pcf", "1"},
                      {technique + ".cull", "none"}};
    if (!coverage.empty()) setup.settings[technique + ".coverage"] = coverage;
    const auto run = runShadows(builder.scene(), setup);
    double sum = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i)
        if (run.tested(i)) sum += 1 - run.visibility[i];
    return sum;
}

TEST(MapRasterTest, ShadowsOfWarpedPointsLieBetweenBothCoverages) {
    std::vector<double> gaps;
    for (const int resolution : {64, 128, 256}) {
        const double standard = shadowArea("mvr", "standard", resolution);
        const double points = shadowArea("vwss", "", resolution);
        const double conservative = shadowArea("mvr", "conservative", resolution);
        std::printf("[ AREA     ] maps of %d: mvr standard %.0f, vwss %.0f, conservative %.0f\n",
                    resolution, standard, points, conservative);
        EXPECT_GE(points, standard);
        EXPECT_LE(points, conservative);
        gaps.push_back(conservative - standard);
    }
    EXPECT_LT(gaps[1], 0.7 * gaps[0]);
    EXPECT_LT(gaps[2], 0.7 * gaps[1]);
}

TEST(MapRasterTest, BiasPushesWrittenDepthsAwayFromTheLight) {
    auto setup = mapsSetup();
    setup.technique = "mvss";
    setup.settings = {{"mvss.resolution", "64"},
                      {"mvss.maps", "5"},
                      {"mvss.constantBias", "0"},
                      {"mvss.slopeBias", "0"}};
    const auto plain = runShadows(mixedScene(), setup);
    setup.settings["mvss.constantBias"] = "0.01";
    const auto constant = runShadows(mixedScene(), setup);
    setup.settings["mvss.constantBias"] = "0";
    setup.settings["mvss.slopeBias"] = "3";
    const auto sloped = runShadows(mixedScene(), setup);
    for (const char* form : {"full", "textbook"}) {
        setup.settings["mvss.form"] = form;
        EXPECT_TRUE(sameMaps(sloped, runShadows(mixedScene(), setup))) << form;
    }
    std::size_t moved = 0;
    for (std::size_t i = 0; i < plain.maps.depths.size(); ++i) {
        if (plain.maps.depths[i] <= 0.011F || plain.maps.depths[i] >= 1) continue;
        ASSERT_NEAR(constant.maps.depths[i], plain.maps.depths[i] - 0.01F, 1e-6F);
        ASSERT_LE(sloped.maps.depths[i], plain.maps.depths[i]);
        moved += sloped.maps.depths[i] < plain.maps.depths[i] ? 1 : 0;
    }
    EXPECT_GT(moved, 1000U);
}

TEST(MapRasterTest, StatsNameTheTrianglesOfAMap) {
    auto setup = mapsSetup();
    setup.settings["mvr.form"] = "textbook";
    const auto run = runShadows(mixedScene(), setup);
    EXPECT_EQ(run.counts.mapTriangles, run.casters.size() / 3);
    EXPECT_EQ(run.counts.mapBytes, 11U * 96 * 96 * 4);
    setup.settings["mvr.form"] = "full";  // leaves out the backs of the sphere
    const auto culled = runShadows(mixedScene(), setup).counts.mapTriangles;
    EXPECT_LT(culled, run.counts.mapTriangles * 7 / 10);
    EXPECT_GT(culled, run.counts.mapTriangles / 4);
}

}  // namespace
}  // namespace penumbra::tests
