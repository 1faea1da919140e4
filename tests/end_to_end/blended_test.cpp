// SPDX-License-Identifier: MIT
// What the camera sees through: whole frames against closed forms, and against the opaque frames
// that a composite is made of.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <random>

#include "host/pipeline.h"
#include "kernels/shared/gbuffer.h"
#include "runtime/error.h"
#include "tests/support/fixtures.h"
#include "tests/support/tiny_scene.h"

namespace penumbra::tests {
namespace {

constexpr int kWidth = 40, kHeight = 30;

RenderOptions frontOptions(const std::string& technique = "none") {
    RenderOptions options;
    options.technique = technique;
    options.width = kWidth;
    options.height = kHeight;
    options.lightSamples = "4";
    options.eye = {{0, 0, 5}};
    options.target = {{0, 0, 0}};
    options.fovDegrees = 40;
    return options;
}

/// Panes of 2 x 2 m before the camera, each of a material of its own, and a light.
class Panes {
  public:
    Panes() {
        scene::Light light;
        light.name = "key";
        light.width = light.height = 0.5;
        light.worldFromLight = scene::lookAt({1, 2, 6}, {0, 0, 0}, {0, 1, 0});
        light.radiance = glm::dvec3(20);
        builder_.scene().lights.push_back(light);
    }
    /// Adds a pane at depth z; unlit, so that it shows its very colour.
    scene::Material& add(float z, const glm::vec4& colour, bool unlit = true) {
        auto& scene = builder_.scene();
        const int node = builder_.addQuad({-1, -1, z}, {2, 0, 0}, {0, 2, 0}, false);
        scene::Material m;
        m.metallic = 0;
        m.baseColor = colour;
        m.unlit = unlit;
        m.alphaMode = colour.w < 1 ? scene::AlphaMode::blend : scene::AlphaMode::opaque;
        scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].mesh)]
            .primitives[0]
            .material = static_cast<int>(scene.materials.size());
        scene.materials.push_back(m);
        return scene.materials.back();
    }
    scene::Scene& scene() { return builder_.scene(); }

  private:
    SceneBuilder builder_;
};

std::array<float, 4> pixelOf(const Frame& frame, int x, int y) {
    std::array<float, 4> rgba{};
    std::memcpy(rgba.data(), &frame.rgba[4 * static_cast<std::size_t>(y * frame.width + x)],
                sizeof rgba);
    return rgba;
}

void expectCentre(const Frame& frame, const std::array<double, 4>& rgba, double tolerance = 1e-5) {
    const auto found = pixelOf(frame, frame.width / 2, frame.height / 2);
    for (std::size_t c = 0; c < 4; ++c)
        EXPECT_NEAR(found[c], rgba[c], tolerance) << "channel " << c;
}

TEST(BlendedFrameTest, ABlendedPaneOverTheBackgroundIsItsAlpha) {
    Panes panes;
    panes.add(0, {0.8F, 0.4F, 0.2F, 0.3F});
    const auto frame = Pipeline(frontOptions(), panes.scene()).render(0);
    expectCentre(frame, {0.24, 0.12, 0.06, 0.3});
    EXPECT_EQ(pixelOf(frame, 0, 0), (std::array<float, 4>{0, 0, 0, 0}));
}

TEST(BlendedFrameTest, AStackOfPanesLetsTheProductThrough) {
    Panes panes;
    panes.add(-1, {1, 1, 1, 1});
    for (int i = 0; i < 7; ++i) panes.add(0.1F * static_cast<float>(i), {0, 0, 0, 0.2F});
    const double through = std::pow(0.8, 7);
    expectCentre(Pipeline(frontOptions(), panes.scene()).render(0), {through, through, through, 1});
}

TEST(BlendedFrameTest, GlassTintsWhatIsBehindIt) {
    Panes panes;
    panes.add(-1, {1, 0.5F, 1, 1});
    panes.add(0, {0.9F, 0.4F, 0.1F, 1}).transmission = 0.5F;
    // T = a t c, and the unlit glass keeps 1 - t of its own colour
    expectCentre(Pipeline(frontOptions(), panes.scene()).render(0),
                 {0.45 + 0.45, 0.2 * 0.5 + 0.2, 0.05 + 0.05, 1});
}

TEST(BlendedFrameTest, SamplesOfAPixelAreCompositedBeforeTheyAreAveraged) {
    Panes panes;
    panes.add(-1, {0.6F, 0.6F, 0.6F, 1});
    panes.add(0, {0, 1, 0, 0.25F});
    auto options = frontOptions();
    options.supersample = 3;
    expectCentre(Pipeline(options, panes.scene()).render(0), {0.45, 0.45 + 0.25, 0.45, 1});
}

/// A floor under a blocker, seen through a tilted pane that is lit and shaded itself.
scene::Scene litPane(float alpha, bool pane) {
    SceneBuilder builder;
    builder.addQuad({-3, -1, 3}, {6, 0, 0}, {0, 0, -6}, false);
    builder.addQuad({-0.5F, 1.5F, 1}, {1.2F, 0, 0}, {0, 0, -2});
    auto& scene = builder.scene();
    scene.materials[0].doubleSided = true;
    if (pane) {
        builder.addQuad({-1.5F, -0.8F, 1.5F}, {3, 0, 0}, {0, 1.6F, -1.2F}, false);
        scene.materials.push_back(scene.materials[0]);
        scene.materials[1].baseColor = {0.9F, 0.3F, 0.2F, alpha};
        if (alpha < 1) scene.materials[1].alphaMode = scene::AlphaMode::blend;
        scene.meshes.back().primitives[0].material = 1;
    }
    scene::Light light;
    light.name = "key";
    light.width = light.height = 0.8;
    light.worldFromLight = scene::lookAt({0.5, 5, 1.5}, {0, 0, 0}, {0, 0, 1});
    light.radiance = glm::dvec3(30);
    scene.lights.push_back(light);
    return scene;
}

RenderOptions litOptions(const std::string& technique) {
    auto options = frontOptions(technique);
    options.eye = {{0, 1, 6}};
    options.lightSamples = "16";
    options.aovs = {"visibility"};
    return options;
}

class BlendedTechniqueTest : public testing::TestWithParam<std::string> {};

TEST_P(BlendedTechniqueTest, ALayerIsLitAndShadowedLikeTheOpaqueSurfaceOfItsPlace) {
    const auto options = litOptions(GetParam());
    const auto blended = Pipeline(options, litPane(0.6F, true)).render(0);
    const auto pane = Pipeline(options, litPane(1, true)).render(0);
    const auto behind = Pipeline(options, litPane(1, false)).render(0);
    std::size_t mixed = 0, dark = 0;
    double worst = 0;
    for (std::size_t i = 0; i < blended.rgba.size(); ++i) {
        const bool seen = pane.rgba[i] != behind.rgba[i];
        const double expected = seen ? 0.6 * pane.rgba[i] + 0.4 * behind.rgba[i] : behind.rgba[i];
        if (i % 4 == 3) continue;
        mixed += seen;
        worst = std::max(worst, std::abs(blended.rgba[i] - expected) / (1 + expected));
        dark += seen && i % 4 == 0 && pane.channels[0].values[i / 4] < 0.3F;
    }
    // pcss turns its filter from receiver to receiver, and layers are receivers in another order;
    // in the map of receivers of essm the pane hides the floor
    const std::map<std::string, double> tolerances = {{"pcss", 0.02}, {"essm", 0.06}};
    EXPECT_LT(worst, tolerances.contains(GetParam()) ? tolerances.at(GetParam()) : 2e-5);
    EXPECT_GT(mixed, 900U);
    if (GetParam() == "none") return;
    EXPECT_GT(dark, 20U);  // the blocker shadows the pane
}

std::vector<std::string> techniqueNames() {
    std::vector<std::string> names;
    for (const auto& entry : visibility::techniques()) names.emplace_back(entry.name);
    return names;
}

INSTANTIATE_TEST_SUITE_P(Techniques, BlendedTechniqueTest, testing::ValuesIn(techniqueNames()),
                         [](const auto& test) { return test.param; });

TEST(BlendedFrameTest, HalfResolutionTestsEachLayerAtItsOwnPlace) {
    auto options = litOptions("vwss");
    options.width = 41;
    options.height = 29;
    options.aovs = {};
    const auto full = Pipeline(options, litPane(0.4F, true)).render(0);
    const auto fullBehind = Pipeline(options, litPane(1, false)).render(0);
    options.settings["vwss.halfResolution"] = "true";
    const auto half = Pipeline(options, litPane(0.4F, true)).render(0);
    const auto halfBehind = Pipeline(options, litPane(1, false)).render(0);
    // Opaque pixels are interpolated, layers are not: only what is behind differs
    for (std::size_t i = 0; i < full.rgba.size(); ++i) {
        const float a = full.rgba[i] - half.rgba[i], b = fullBehind.rgba[i] - halfBehind.rgba[i];
        EXPECT_TRUE(std::abs(a - b) < 1e-4 || std::abs(a - 0.6F * b) < 1e-4) << a << ' ' << b;
    }
}

TEST(BlendedFrameTest, LightThroughGlassIsTintedAsTheViewThroughIt) {
    // Glass over a floor: the floor in its shadow, and an unlit white wall seen through it
    SceneBuilder builder;
    auto& scene = builder.scene();
    builder.addQuad({-4, -1, 4}, {8, 0, 0}, {0, 0, -8}, false);
    const int pane = builder.addQuad({-4, 2, 4}, {8, 0, 0}, {0, 0, -8});
    auto glass = scene.materials[0];
    glass.doubleSided = true;
    glass.baseColor = {0.9F, 0.5F, 0.2F, 1};
    glass.transmission = 0.8F;
    scene.materials.push_back(glass);
    scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(pane)].mesh)]
        .primitives[0]
        .material = 1;
    scene::Light light;
    light.width = light.height = 0.1;
    light.worldFromLight = scene::lookAt({0, 6, 0}, {0, 0, 0}, {0, 0, 1});
    scene.lights.push_back(light);
    auto options = frontOptions("raytrace");
    options.eye = {{0, 0, 3}};
    options.target = {{0, -1, 0}};
    options.aovs = {"visibility"};
    const auto shadow = Pipeline(options, scene).render(0);
    Panes panes;
    panes.add(-1, {1, 1, 1, 1});
    auto& unlitGlass = panes.add(0, glass.baseColor);
    unlitGlass.transmission = glass.transmission;
    const auto view = Pipeline(frontOptions(), panes.scene()).render(0);
    const auto seen = pixelOf(view, kWidth / 2, kHeight / 2);
    const std::size_t centre = static_cast<std::size_t>(kHeight / 2 * kWidth + kWidth / 2);
    for (std::size_t c = 0; c < 3; ++c) {
        const double own = (1 - 0.8) * glass.baseColor[static_cast<int>(c)];
        EXPECT_NEAR(shadow.channels[c].values[centre], seen[c] - own, 1e-4);
    }
}

TEST(BlendedFrameTest, PermutedTrianglesGiveTheSameFrame) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> at(-1.2F, 1.2F), unit(0, 1);
    SceneBuilder builder;
    std::vector<glm::vec3> corners;
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 150; ++i) {
        indices.push_back(i);
        corners.push_back({at(random), at(random), i / 3 % 4 ? at(random) : 0.5F});
    }
    const int node = builder.addMesh(corners, indices);
    auto& scene = builder.scene();
    scene.lights = tinyScene().lights;
    auto& m = builder.material();
    m.doubleSided = true;
    m.alphaMode = scene::AlphaMode::blend;
    m.baseColor.w = 0.5F;
    auto& p =
        scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].mesh)]
            .primitives[0];
    for (std::size_t i = 0; i < p.positions.size(); ++i)
        p.colors.push_back({unit(random), unit(random), unit(random), 1});
    const auto first = Pipeline(frontOptions("raytrace"), scene).render(0);
    std::reverse(p.indices.begin(), p.indices.end());
    for (std::size_t i = 0; i < p.indices.size(); i += 3) std::swap(p.indices[i], p.indices[i + 2]);
    const auto second = Pipeline(frontOptions("raytrace"), scene).render(0);
    EXPECT_EQ(first.rgba, second.rgba);
}

TEST(BlendedFrameTest, ChannelsShowTheFirstSurfaceOfAnAlphaAboveOneHalf) {
    for (const float alpha : {0.4F, 0.6F}) {
        Panes panes;
        panes.add(-1, {0.1F, 0.2F, 0.3F, 1}, false);
        panes.add(0, {0.7F, 0.8F, 0.9F, alpha}, false);
        panes.add(1, {0.5F, 0.5F, 0.5F, 0.3F}, false);
        auto options = frontOptions("raytrace");
        options.aovs = {"depth", "id", "albedo", "visibility"};
        const auto frame = Pipeline(options, panes.scene()).render(0);
        const std::size_t centre = static_cast<std::size_t>(kHeight / 2 * kWidth + kWidth / 2);
        for (const auto& channel : frame.channels) {
            const bool pane = alpha > 0.5F;
            if (channel.name == "Z") {
                EXPECT_NEAR(channel.values[centre], pane ? 5 : 6, 1e-4);
            } else if (channel.name == "albedo.R") {
                EXPECT_NEAR(channel.values[centre], pane ? 0.7 : 0.1, 1e-6);
            } else if (channel.name == "id.object") {
                EXPECT_EQ(channel.ids[centre], pane ? 2U : 1U);
            }
        }
        EXPECT_EQ(frame.channels.size(), 1U + 3 + 1 + 3);
    }
}

/// Panes that fly in from the side one after the other: each frame has more fragments.
scene::Scene flyingPanes() {
    auto scene = litPane(0.4F, true);
    SceneBuilder more;
    scene::Animation clip;
    for (int i = 0; i < 6; ++i) {
        more.addQuad({-1.4F, -0.7F, 1.6F + 0.1F * static_cast<float>(i)}, {2.8F, 0, 0},
                     {0, 1.6F, -1.0F});
        auto mesh = more.scene().meshes.back();
        mesh.primitives[0].material = 1;
        scene::Node node;
        node.mesh = static_cast<int>(scene.meshes.size());
        scene::Channel channel;
        channel.node = static_cast<int>(scene.nodes.size());
        channel.interpolation = scene::Interpolation::step;
        channel.times = {0, 0.1F * static_cast<float>(i) + 0.05F};
        channel.values = {50, 0, 0, 0, 0, 0};
        clip.channels.push_back(channel);
        scene.meshes.push_back(mesh);
        scene.order.push_back(static_cast<int>(scene.nodes.size()));
        scene.nodes.push_back(node);
    }
    scene.animations.push_back(clip);
    return scene;
}

TEST(BlendedFrameTest, ListsThatGrowInTheMiddleOfASequenceChangeNoFrame) {
    for (const int temporal : {0, 3}) {
        auto options = litOptions("vwss");
        options.fps = 10;
        options.temporal = temporal;
        Pipeline sequence(options, flyingPanes());
        int repetitions = 0;
        std::uint32_t fragments = 0;
        for (int f = 0; f < sequence.frameCount(); ++f) {
            const auto frame = sequence.render(f);
            const auto alone = Pipeline(options, flyingPanes()).render(f);
            EXPECT_EQ(frame.rgba, alone.rgba) << "frame " << f;
            EXPECT_EQ(frame.channels[0].values, alone.channels[0].values) << "frame " << f;
            const auto stats = nlohmann::json::parse(frame.statsJson);
            repetitions += f > 0 ? stats["retries"].get<int>() : 0;
            EXPECT_GE(stats["blendedFragments"].get<std::uint32_t>(), fragments);
            fragments = stats["blendedFragments"];
            EXPECT_EQ(stats["blendedLayers"], f + 1);
        }
        EXPECT_GT(repetitions, 0);
    }
}

TEST(BlendedFrameTest, ThePlanCountsTheListsAndTooManyAreRefusedWithFigures) {
    Panes panes;
    for (int i = 0; i < 60; ++i) panes.add(0.01F * static_cast<float>(i), {0, 0, 0, 0.2F});
    auto options = frontOptions();
    options.width = 400;
    options.height = 300;
    Pipeline free(options, panes.scene());
    const auto frame = free.render(0);
    const std::uint64_t planned = nlohmann::json::parse(free.statsJson())["memory"]["planned"];
    const std::uint64_t fragments = nlohmann::json::parse(frame.statsJson)["blendedFragments"];
    EXPECT_GT(fragments, 60U * 9000);
    EXPECT_GT(planned, fragments * GB_PLANES * sizeof(float));
    options.memoryMegabytes = planned / (1024 * 1024) + 1;
    EXPECT_EQ(Pipeline(options, panes.scene()).render(0).rgba, frame.rgba);
    options.memoryMegabytes = planned / (1024 * 1024) / 2;
    try {
        Pipeline(options, panes.scene()).render(0);
        FAIL() << "half of what is needed was enough";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::outOfMemory);
        EXPECT_NE(std::string(error.what()).find("MB"), std::string::npos) << error.what();
    }
}

TEST(BlendedFrameTest, TheGlassOfARealVaseShowsTheFlowersInIt) {
    ASSET_OR_SKIP(file, "GlassVaseFlowers/GlassVaseFlowers.glb");
    RenderOptions options;
    options.scene = file;
    options.technique = "none";
    options.width = 160;
    options.height = 120;
    auto scene = loadScene(options);
    const auto through = Pipeline(options, scene).render(0);
    for (auto& m : scene.materials) {
        m.transmission = 0;
        if (m.alphaMode == scene::AlphaMode::blend) m.alphaMode = scene::AlphaMode::opaque;
    }
    const auto opaque = Pipeline(options, scene).render(0);
    // Green stems, where opaque vases are grey
    const auto greens = [](const Frame& frame) {
        int count = 0;
        for (std::size_t i = 0; i < frame.rgba.size(); i += 4)
            count += frame.rgba[i + 1] > 1.5F * frame.rgba[i + 2] && frame.rgba[i + 1] > 0;
        return count;
    };
    EXPECT_GT(greens(through), greens(opaque) + 100);
}

}  // namespace
}  // namespace penumbra::tests
