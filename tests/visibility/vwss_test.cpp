// SPDX-License-Identifier: MIT
// Properties of view-warped soft shadows that need no reference: variants agree to the bit, and
// simple scenes have known answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "host/pipeline.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

scene::Scene floorAndSphere() {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    builder.addSphere({0, 0.9F, 0}, 0.6F, 16, 24);
    builder.addQuad({-1, 1.8F, -0.3F}, {0.5F, 0, 0}, {0, 0.2F, 0.5F});
    return builder.scene();
}

ShadowSetup smallSetup() {
    ShadowSetup setup;
    setup.light = "rect:at=0.6,5,0.8;aim=0,0,0;size=1x1";
    setup.eye = {1, 3, 4};
    setup.width = 61;
    setup.height = 37;
    setup.samples = "11";
    setup.keepMaps = true;
    setup.settings = {{"vwss.resolution", "96"}};
    return setup;
}

template <typename T>
bool sameBytes(const std::vector<T>& a, const std::vector<T>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

void expectSame(const ShadowRun& a, const ShadowRun& b, const std::string& what) {
    EXPECT_TRUE(sameBytes(a.maps.depths, b.maps.depths)) << what;
    EXPECT_TRUE(sameBytes(a.visibility, b.visibility)) << what;
    EXPECT_TRUE(sameBytes(a.state, b.state)) << what;
}

ShadowRun runWith(const scene::Scene& scene, ShadowSetup setup, const SettingValues& settings) {
    for (const auto& [key, value] : settings) setup.settings[key] = value;
    return runShadows(scene, setup);
}

/// Smallest and largest visibility of the tested pixels.
std::pair<float, float> range(const ShadowRun& run) {
    std::pair<float, float> result(2, -1);
    for (std::size_t i = 0; i < run.pixels(); ++i)
        if (run.tested(i))
            result = {std::min(result.first, run.visibility[i]),
                      std::max(result.second, run.visibility[i])};
    return result;
}

TEST(Vwss, EveryVariantGivesTheSameMapsToTheBit) {
    const auto scene = floorAndSphere();
    for (const char* bits : {"32", "16"}) {
        const auto first = runWith(scene, smallSetup(), {{"vwss.depthBits", bits}});
        ASSERT_EQ(first.maps.views, 11);
        ASSERT_GT(*std::max_element(first.maps.depths.begin(), first.maps.depths.end()), 0.1F);
        for (const char* parallelism : {"auto", "serial", "partial", "full", "owned"})
            for (const char* buffered : {"true", "false"})
                for (const char* batch : {"0", "1", "4", "11"})
                    expectSame(first,
                               runWith(scene, smallSetup(),
                                       {{"vwss.depthBits", bits},
                                        {"vwss.parallelism", parallelism},
                                        {"vwss.buffered", buffered},
                                        {"vwss.viewsPerBatch", batch},
                                        {"vwss.viewsPerPass", "3"}}),
                               std::string(bits) + parallelism + buffered + batch);
    }
}

TEST(Vwss, StoredPrecisionIsTheSameInEveryTraversal) {
    const auto scene = floorAndSphere();
    for (const char* precision : {"half", "fixed"}) {
        const SettingValues settings = {{"vwss.precision", precision}};
        const auto first = runWith(scene, smallSetup(), settings);
        for (const char* parallelism : {"serial", "full", "owned"})
            expectSame(first,
                       runWith(scene, smallSetup(),
                               {{"vwss.precision", precision}, {"vwss.parallelism", parallelism}}),
                       std::string(precision) + parallelism);
    }
}

TEST(Vwss, DefaultPipelineKeepsTheMapsOfTheTechnique) {
    RenderOptions options;
    options.width = 32, options.height = 18;
    options.lightSamples = "3";
    options.aovs = {"depth-maps", "visibility"};
    options.device = "cpu";
    options.settings = {{"vwss.resolution", "64"}};
    std::vector<std::vector<float>> maps;
    for (const char* parallelism : {"owned", "full"}) {
        options.settings["vwss.parallelism"] = parallelism;
        Pipeline pipeline(options);
        const auto frame = pipeline.render(0);
        ASSERT_EQ(frame.depthMaps.size(), 3U);
        EXPECT_EQ(frame.depthMapSize, 64);
        maps.push_back(frame.depthMaps[1].values);
        const auto stats = nlohmann::json::parse(frame.statsJson);
        EXPECT_GT(stats["points"].get<int>(), 0);
    }
    EXPECT_EQ(maps[0].size(), 64U * 64U);
    EXPECT_TRUE(sameBytes(maps[0], maps[1]));
}

TEST(Vwss, AListThatOverflowsIsGrownAndTheFrameRepeatedWithTheSameMaps) {
    const auto scene = floorAndSphere();
    auto setup = smallSetup();
    setup.settings = {{"vwss.resolution", "512"}, {"vwss.density", "3"}};
    setup.samples = "3";
    const auto grown = runShadows(scene, setup);
    ASSERT_GT(grown.counts.points, 1U << 18);
    EXPECT_EQ(grown.retries, 1);
    // Without a buffer nothing overflows
    expectSame(grown, runWith(scene, setup, {{"vwss.buffered", "false"}}), "overflow");
    expectSame(grown, runWith(scene, setup, {{"vwss.parallelism", "full"}}), "overflow, full");
}

TEST(Vwss, AnyNumberOfViewsWorks) {
    const auto scene = floorAndSphere();
    for (const char* samples : {"1", "2", "63", "300"}) {
        auto setup = smallSetup();
        setup.samples = samples;
        setup.settings["vwss.resolution"] = "64";
        const auto run = runShadows(scene, setup);
        EXPECT_EQ(run.maps.views, std::stoi(samples));
        const auto [low, high] = range(run);
        EXPECT_EQ(low, 0) << samples;
        EXPECT_EQ(high, 1) << samples;
    }
}

TEST(Vwss, TheSameFrameTwiceIsTheSameBytes) {
    const auto scene = floorAndSphere();
    auto setup = smallSetup();
    setup.settings["vwss.parallelism"] = "full";
    expectSame(runShadows(scene, setup), runShadows(scene, setup), "again");
}

TEST(Vwss, OrderOfTrianglesDoesNotChangeTheImage) {
    auto scene = floorAndSphere();
    const auto first = runShadows(scene, smallSetup());
    std::mt19937 random(3);
    auto& indices = scene.meshes[1].primitives[0].indices;
    std::vector<std::array<std::uint32_t, 3>> triangles(indices.size() / 3);
    std::memcpy(triangles.data(), indices.data(), indices.size() * sizeof(std::uint32_t));
    std::shuffle(triangles.begin(), triangles.end(), random);
    std::memcpy(indices.data(), triangles.data(), indices.size() * sizeof(std::uint32_t));
    std::swap(scene.order[0], scene.order[2]);
    for (const char* parallelism : {"owned", "full"})
        expectSame(first, runWith(scene, smallSetup(), {{"vwss.parallelism", parallelism}}),
                   parallelism);
}

TEST(Vwss, WithoutCastersEverythingIsLit) {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
    builder.addQuad({-0.5F, 0.5F, 0.5F}, {1, 0, 0}, {0, 0, -1}, false);
    const auto run = runShadows(builder.scene(), smallSetup());
    EXPECT_EQ(run.counts.points, 0U);
    const auto [low, high] = range(run);
    EXPECT_EQ(low, 1);
    EXPECT_EQ(high, 1);
    for (const float depth : run.maps.depths) ASSERT_EQ(depth, 0);
}

TEST(Vwss, AFullBlockerHidesTheWholeLight) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addQuad({-4, 2, -4}, {8, 0, 0}, {0, 0, 8});
    for (const char* pcf : {"1", "5", "9", "bilinear"}) {
        auto setup = smallSetup();
        setup.eye = {1, 1.5, 2};
        setup.settings["vwss.pcf"] = pcf;
        const auto run = runShadows(builder.scene(), setup);
        int floor = 0;
        for (std::size_t i = 0; i < run.pixels(); ++i) {
            if (!run.tested(i) || run.vectorAt(GB_GEOMETRIC, i).y < 0.9F) continue;
            EXPECT_EQ(run.visibility[i], 0);
            ++floor;
        }
        EXPECT_GT(floor, 300) << pcf;
    }
}

TEST(Vwss, OneSampleWithOneTapGivesHardShadows) {
    auto setup = smallSetup();
    setup.samples = "1";
    const auto run = runWith(floorAndSphere(), setup, {{"vwss.pcf", "1"}});
    int hidden = 0, seen = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        EXPECT_TRUE(run.visibility[i] == 0 || run.visibility[i] == 1) << run.visibility[i];
        ++(run.visibility[i] == 0 ? hidden : seen);
    }
    EXPECT_GT(hidden, 30);
    EXPECT_GT(seen, 300);
}

TEST(Vwss, AReceiverThatTakesNoShadowsIsLit) {
    auto scene = floorAndSphere();
    scene.nodes[0].receiveShadow = false;
    const auto run = runShadows(scene, smallSetup());
    int floor = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        std::uint32_t object = 0;
        std::memcpy(&object, &run.planes[GB_OBJECT * run.stride + i], sizeof object);
        if (object != 1) continue;
        EXPECT_EQ(run.visibility[i], 1);
        EXPECT_FALSE(run.tested(i));
        ++floor;
    }
    EXPECT_GT(floor, 300);
}

TEST(Vwss, PointsOutsideOfAMapAreClippedAndNotWrapped) {
    // A strip along the left edge of a narrow field of view, and none at the right
    SceneBuilder builder;
    builder.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6}, false);
    builder.addQuad({-30, 2, 5}, {29.6F, 0, 0}, {0, 0, -10});
    builder.material().doubleSided = true;
    auto setup = smallSetup();
    setup.light = "rect:at=0,5,0;aim=0,0,0;up=0,0,1;size=1x1;fov=40;near=1";
    setup.eye = {0, 1.9, 0.1};
    setup.fovDegrees = 100;
    for (const char* parallelism : {"owned", "full"}) {
        const auto run = runWith(builder.scene(), setup, {{"vwss.parallelism", parallelism}});
        const auto size = static_cast<std::size_t>(run.maps.size);
        for (std::size_t view = 0; view < static_cast<std::size_t>(run.maps.views); ++view) {
            // At height 2 the map spans +-1.09 m about its sample: the strip ends left of x = -0.4
            const double sample = run.light.samples[view].x * run.light.axisX.x;
            const double edge = (-0.4 - sample) / (3 * std::tan(20 * M_PI / 180));
            const double column =
                static_cast<double>(size) * (0.5 + 0.5 * edge * run.light.axisX.x);
            int wrong = 0;
            for (std::size_t row = 0; row < size; ++row)
                for (std::size_t x = 0; x < size; ++x) {
                    if (std::abs(static_cast<double>(x) + 0.5 - column) < 1.5) continue;
                    const bool left = (static_cast<double>(x) < column) == (run.light.axisX.x > 0);
                    wrong += (run.maps.depths[(view * size + row) * size + x] > 0) != left;
                }
            EXPECT_EQ(wrong, 0) << parallelism << " view " << view;
        }
    }
}

TEST(Vwss, AMirroredSceneGivesTheMirroredImage) {
    SceneBuilder builder, mirrored;
    for (auto* b : {&builder, &mirrored}) {
        b->material().doubleSided = true;
        const float s = b == &builder ? 1.0F : -1.0F;
        b->addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
        b->addBox({std::min(0.2F * s, 0.7F * s), 0.1F, -0.4F},
                  {std::max(0.2F * s, 0.7F * s), 0.6F, 0.5F});
    }
    auto setup = smallSetup();
    setup.samples = "8x8";
    setup.settings["vwss.resolution"] = "512";
    setup.eye = {0, 3, 4};
    setup.width = 60;
    setup.light = "rect:at=0.8,5,-1.5;aim=0,0,0;size=1x1";
    const auto a = runShadows(builder.scene(), setup);
    setup.light = "rect:at=-0.8,5,-1.5;aim=0,0,0;size=1x1";
    const auto b = runShadows(mirrored.scene(), setup);
    double sum = 0;
    int count = 0, shadowed = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const auto i = static_cast<std::size_t>(y * a.width + x);
            const auto j = static_cast<std::size_t>(y * a.width + a.width - 1 - x);
            if (!a.tested(i) || !b.tested(j)) continue;
            sum += std::abs(a.visibility[i] - b.visibility[j]);
            shadowed += a.visibility[i] < 0.9F;
            ++count;
        }
    EXPECT_GT(count, 1000);
    EXPECT_GT(shadowed, 20);
    EXPECT_LT(sum / count, 0.003);
}

TEST(Vwss, CastersNearerThanTheNearPlaneAreCountedAndStillBlock) {
    SceneBuilder builder;
    builder.addQuad({-0.5F, 0, 0.5F}, {1, 0, 0}, {0, 0, -1}, false);
    builder.addQuad({-2, 3.9F, 2}, {4, 0, 0}, {0, 0, -4});
    builder.material().doubleSided = true;
    auto setup = smallSetup();
    setup.light = "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1";  // near is a quarter metre at least
    setup.eye = {0.5, 1.5, 1.5};
    setup.settings["vwss.density"] = "2";  // equation 3 fills texels from the near plane on
    const auto run = runShadows(builder.scene(), setup);
    EXPECT_GT(run.counts.nearPoints, 0U);
    const auto [low, high] = range(run);
    EXPECT_EQ(low, 0);
    EXPECT_EQ(high, 0);
}

/// Mean visibility of the floor under a sheet of this material that covers the whole light.
double underSheet(const scene::Material& material, const SettingValues& settings) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addQuad({-4, 2, -4}, {8, 0, 0}, {0, 0, 8});
    auto& scene = builder.scene();
    scene.materials.push_back(material);
    scene.meshes[1].primitives[0].material = 1;
    auto setup = smallSetup();
    setup.eye = {1, 1.5, 2};
    setup.samples = "64";
    const auto run = runWith(scene, setup, settings);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i) || run.vectorAt(GB_GEOMETRIC, i).y < 0.9F) continue;
        sum += run.visibility[i];
        ++count;
    }
    EXPECT_GT(count, 300);
    return sum / std::max(count, 1);
}

TEST(Vwss, BlendedSurfacesBlockTheirShareOfTheSamples) {
    scene::Material material;
    material.alphaMode = scene::AlphaMode::blend;
    const struct {
        float alpha, transmission;
        double visibility;
    } cases[] = {{1, 0, 0}, {0.5F, 0, 0.5}, {0.25F, 0, 0.75}, {1, 0.75F, 0.75}, {0, 0, 1}};
    for (const auto& c : cases)
        for (const char* parallelism : {"owned", "full"})
            for (const char* buffered : {"true", "false"}) {
                material.baseColor.w = c.alpha;
                material.transmission = c.transmission;
                EXPECT_NEAR(underSheet(material, {{"vwss.parallelism", parallelism},
                                                  {"vwss.buffered", buffered}}),
                            c.visibility, 1e-6)
                    << c.alpha << parallelism << buffered;
            }
}

TEST(Vwss, MaskedSurfacesBlockFromTheirCutoffOn) {
    scene::Material material;
    material.alphaMode = scene::AlphaMode::mask;
    material.baseColor.w = 0.5F;
    EXPECT_EQ(underSheet(material, {}), 0);
    material.alphaCutoff = 0.51F;
    EXPECT_EQ(underSheet(material, {}), 1);
}

}  // namespace
}  // namespace penumbra::tests
