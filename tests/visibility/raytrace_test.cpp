// SPDX-License-Identifier: MIT
// Rays against the brute-force twin in double: opaque and masked surfaces, colours of blended ones,
// which pixels are traced.
#include "host/visibility/raytrace.h"

#include <cmath>

#include "tests/reference/raytrace_ref.h"
#include "tests/support/fixtures.h"
#include "tests/support/textured_scene.h"

namespace penumbra::tests {
namespace {

ShadowSetup texturedSetup() {
    ShadowSetup setup;
    setup.technique = "raytrace";
    setup.light = kTexturedLight;
    setup.samples = "13";  // fills no whole vector
    setup.eye = {1.5, 4, 4};
    setup.width = 53;
    setup.height = 37;
    return setup;
}

struct Differences {
    std::size_t tested = 0, wrong = 0;
    double shadowed = 0;  ///< share of pixels that see less than all
};

/// Pixels whose visibility differs from the twin's in any channel. Logarithms in 1/65536 and float
/// textures are good for 3e-4; beyond it a whole ray went another way.
Differences differences(const scene::Scene& scene, const ShadowRun& run) {
    const RayReference twin(scene, run.pose);
    Differences result;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        const auto expected = twin.visibility(run, i);
        double worst = 0;
        for (std::size_t c = 0; (c + 1) * run.stride <= run.visibility.size(); ++c)
            worst =
                std::max(worst, std::abs(expected[static_cast<int>(c)] -
                                         static_cast<double>(run.visibility[c * run.stride + i])));
        ++result.tested;
        result.wrong += worst > 3e-4;
        result.shadowed += expected.x < 1;
    }
    result.shadowed /= static_cast<double>(std::max<std::size_t>(result.tested, 1));
    return result;
}

class RaytraceSurfaceTest : public testing::TestWithParam<std::vector<Surface>> {};

TEST_P(RaytraceSurfaceTest, EqualTheTwinInEveryChannel) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const auto scene = texturedScene(seed, 20, GetParam());
        const auto run = runShadows(scene, texturedSetup());
        const auto result = differences(scene, run);
        EXPECT_GT(result.tested, 800U);
        EXPECT_GT(result.shadowed, 0.2);
        // Rays through an edge or a texel's border go either way: one pixel in a thousand
        EXPECT_LE(result.wrong, 2U) << "of " << result.tested << ", seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Surfaces, RaytraceSurfaceTest,
    testing::Values(std::vector{Surface::opaque}, std::vector{Surface::maskNearest},
                    std::vector{Surface::maskSmooth}, std::vector{Surface::blend},
                    std::vector{Surface::blendTexture}, std::vector{Surface::transmission},
                    std::vector{Surface::glass},
                    std::vector{Surface::opaque, Surface::maskNearest, Surface::maskSmooth,
                                Surface::blend, Surface::blendTexture, Surface::transmission,
                                Surface::glass}));

TEST(RaytraceTwinTest, SampleCountsAroundTheVectorWidthEqualTheTwin) {
    const auto scene = texturedScene(4, 30, {Surface::opaque, Surface::blend});
    auto setup = texturedSetup();
    setup.width = 23;
    setup.height = 19;
    for (const char* samples : {"1", "7", "8", "9", "15", "16", "17", "33", "100"}) {
        setup.samples = samples;
        const auto result = differences(scene, runShadows(scene, setup));
        EXPECT_GT(result.tested, 250U);
        EXPECT_LE(result.wrong, 2U) << samples;
    }
}

/// What RayPass needs, for a scene with blended surfaces.
struct Traced {
    explicit Traced(const scene::Scene& traced)
        : scene(traced),
          bounds(scene::clipBounds(scene, {})),
          pose(scene::poseAt(scene, {}, 0)),
          geometry(program("frame"), scene, bounds.centre()),
          gbufferPass(program("frame"), 53, 37),
          bvh(program("frame"), program("raytrace")) {
        auto lit = scene;
        lit.lights = {scene::parseLight(kTexturedLight)};
        light = scene::lightsAt(lit, pose, bounds, scene::parseSampleCount("13", {})).at(0);
        scene::CameraChoice choice;
        choice.eye = {1.5, 4, 4};
        choice.target = {0, 0, 0};
        const auto camera = scene::cameraAt(scene, pose, choice, bounds, 53.0 / 37);
        const auto& mesh = geometry.run(pose);
        do gbufferPass.run(mesh, camera, bounds.centre());
        while (gbufferPass.grew());
        bvh.build(mesh, bounds, bounds.centre());
        pass = std::make_unique<visibility::RayPass>(program("raytrace"), 53,
                                                     gbufferPass.result().rows());
        stride = static_cast<std::size_t>(gbufferPass.result().planeStride);
        visibility.planes = runtime::Buffer<float>(device(), "visibility", 3 * stride);
        visibility.state = runtime::Buffer<std::uint32_t>(device(), "states", stride);
    }
    std::vector<float> run(int channels, std::uint32_t onlyState, bool classify) {
        visibility.channels = channels;
        pass->run({geometry.mesh(), gbufferPass.result(), light, bounds, bounds.centre()}, bvh,
                  onlyState, classify, visibility);
        return visibility.planes.download();
    }
    scene::Scene scene;
    scene::Bounds bounds;
    scene::Pose pose;
    geometry::Geometry geometry;
    gbuffer::GBufferPass gbufferPass;
    visibility::Bvh bvh;
    std::unique_ptr<visibility::RayPass> pass;
    scene::AreaLight light;
    std::size_t stride = 0;
    visibility::Visibility visibility;
};

TEST(RaytraceTwinTest, OneChannelOfABlendedSceneIsTheMeanOfThree) {
    Traced traced(texturedScene(5, 30, {Surface::blend, Surface::glass}));
    const auto three = traced.run(3, STATE_TESTED, true);
    const auto one = traced.run(1, STATE_TESTED, true);
    std::size_t coloured = 0;
    for (std::size_t i = 0; i < traced.stride; ++i) {
        const double r = three[i], g = three[traced.stride + i], b = three[2 * traced.stride + i];
        EXPECT_NEAR(one[i], (r + g + b) / 3, 1e-4);
        coloured += std::abs(r - b) > 0.01;
    }
    EXPECT_GT(coloured, 300U);
}

TEST(RaytraceTwinTest, OnlyPixelsOfTheStateAskedForAreTracedAndMarked) {
    Traced traced(texturedScene(6, 40, {Surface::opaque}));
    const auto whole = traced.run(1, STATE_TESTED, true);
    const auto classified = traced.visibility.state.download();
    auto states = classified;
    for (std::size_t i = 0; i < states.size(); ++i)
        if (states[i] == STATE_TESTED && i % 3 == 0) states[i] = STATE_OUTSIDE;
    traced.visibility.state.upload(states);
    traced.visibility.planes.fill(-7.0F);
    const auto some = traced.run(1, STATE_OUTSIDE, false);
    for (std::size_t i = 0; i < states.size(); ++i)
        EXPECT_EQ(some[i], states[i] == STATE_OUTSIDE ? whole[i] : -7.0F) << i;
    EXPECT_EQ(traced.visibility.state.download(), classified);
}

}  // namespace
}  // namespace penumbra::tests
