// SPDX-License-Identifier: MIT
// What a change of the scene must do to the image, for every registered technique: a new one is
// held to all of it without a word here. What a technique cannot keep stands in kExceptions.
#include "tests/support/metamorphic.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

class MetamorphicTest : public testing::TestWithParam<std::string> {
  protected:
    ShadowRun run(const scene::Scene& scene, ShadowSetup setup) const {
        setup.technique = GetParam();
        return runShadows(scene, setup);
    }
    void expectKept(const char* property, const Difference& found) const {
        const auto allowed = allowedFor(GetParam(), property);
        std::printf("[ PROPERTY ] %s, %s: mean %.5f, largest %.4f of %zu\n", GetParam().c_str(),
                    property, found.mean(), found.largest, found.pixels);
        EXPECT_GT(found.pixels, 500U);
        EXPECT_LE(found.mean(), allowed.mean) << allowed.why;
        EXPECT_LE(found.largest, allowed.largest) << allowed.why;
    }
};

/// The fit of the light's views is set, so that no change of the scene moves their texels.
ShadowSetup fixedSetup(double lightX = 0.75) {
    ShadowSetup setup;
    setup.light =
        fmt::format("rect:at={},6,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10;fov=60;near=3", lightX);
    setup.samples = "4x4";  // a set that mirrors into itself
    setup.eye = {0, 3, 4};
    setup.width = 64;
    setup.height = 48;
    return setup;
}

void transform(scene::Scene& scene, const glm::dmat4& matrix) {
    for (auto& node : scene.nodes) node.matrix = matrix * node.matrix;
}

TEST_P(MetamorphicTest, AMirroredSceneGivesTheMirroredImage) {
    auto scene = metamorphicSolids();
    const auto plain = run(scene, fixedSetup());
    transform(scene, glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1)));
    const auto mirrored = run(scene, fixedSetup(-0.75));
    Difference found, spread;
    for (std::size_t i = 0; i < plain.pixels(); ++i) {
        const auto width = static_cast<std::size_t>(plain.width);
        const std::size_t other = i / width * width + (width - 1 - i % width);
        if (!plain.tested(i) || !mirrored.tested(other)) continue;
        found.add(plain.visibility[i] - mirrored.visibility[other]);
        spread.add(plain.visibility[i] - plain.visibility[other]);
    }
    expectKept("mirror", found);
    EXPECT_GT(spread.mean(), 0.03);  // the scene is not its own mirror image
}

TEST_P(MetamorphicTest, TheOrderOfTrianglesAndMeshesChangesNothing) {
    auto scene = metamorphicSolids();
    const auto first = run(scene, fixedSetup());
    std::mt19937 random(4);
    for (auto& mesh : scene.meshes) {
        auto& indices = mesh.primitives[0].indices;
        for (std::size_t t = indices.size() / 3 - 1; t > 0; --t) {
            const std::size_t other = random() % (t + 1);
            for (std::size_t c = 0; c < 3; ++c)
                std::swap(indices[3 * t + c], indices[3 * other + c]);
        }
    }
    std::reverse(scene.order.begin(), scene.order.end());
    expectKept("order", differenceOf(first, run(scene, fixedSetup())));
}

TEST_P(MetamorphicTest, ALightIsTheMeanOfItsHalves) {
    const auto scene = metamorphicSolids();
    const auto with = [&](double x, int width, const char* samples) {
        auto setup = fixedSetup();
        setup.samples = samples;
        setup.light = fmt::format(
            "rect:at={},6,0.25;aim={},0,0.25;up=0,0,1;size={}x1;radiance=10;fov=90;near=3", x, x,
            width);
        return run(scene, setup);
    };
    const auto whole = with(0.5, 2, "8x4"), left = with(0, 1, "4x4"), right = with(1, 1, "4x4");
    Difference found;
    for (std::size_t i = 0; i < whole.pixels(); ++i)
        if (whole.tested(i) && left.tested(i) && right.tested(i))
            found.add(whole.visibility[i] - 0.5F * (left.visibility[i] + right.visibility[i]));
    expectKept("halves", found);
}

TEST_P(MetamorphicTest, TakingAnOccluderAwayDarkensNothing) {
    auto scene = metamorphicSolids();
    const auto before = run(scene, fixedSetup());
    scene.nodes[kSolidsSphere].castShadow = false;  // others hold the bounds
    const auto after = run(scene, fixedSetup());
    Difference darker, change;
    for (std::size_t i = 0; i < before.pixels(); ++i) {
        if (!before.tested(i) || !after.tested(i)) continue;
        darker.add(std::max(before.visibility[i] - after.visibility[i], 0.0F));
        change.add(before.visibility[i] - after.visibility[i]);
    }
    expectKept("removal", darker);
    EXPECT_GT(change.mean(), 0.01);
}

TEST_P(MetamorphicTest, AReceiverWithoutOccludersIsLit) {
    Difference acne;
    for (const float lean : {0.0F, 0.5F, 1.5F}) {
        SceneBuilder builder;
        builder.addQuad({-1, -lean, 1}, {2, 0, 0}, {0, 2 * lean, -2});
        auto setup = fixedSetup();
        setup.light = "rect:at=0.75,6,2;aim=0,0,0;up=0,0,1;size=1x1;radiance=10";
        const auto open = run(builder.scene(), setup);
        for (std::size_t i = 0; i < open.pixels(); ++i)
            if (open.tested(i)) acne.add(1 - open.visibility[i]);
    }
    expectKept("open", acne);
}

/// Everything `scale` times as large; bounds, fit and bias are automatic.
ShadowRun scaledRun(const std::string& technique, scene::Scene scene, double scale,
                    const glm::dvec3& eye, const glm::dvec3& target,
                    const SettingValues& settings = {}) {
    transform(scene, glm::scale(glm::dmat4(1), glm::dvec3(scale)));
    ShadowSetup setup;
    setup.technique = technique;
    const glm::dvec3 light = scale * glm::dvec3(-3, 4, 1);
    setup.light = fmt::format("rect:at={},{},{};aim=0,0,0;up=0,0,1;size={}x{};radiance=10", light.x,
                              light.y, light.z, scale, scale);
    setup.samples = "4x4";
    setup.eye = scale * eye;
    setup.target = scale * target;
    setup.settings = settings;
    setup.width = 96;
    setup.height = 72;
    return runShadows(scene, setup);
}

constexpr double kScales[] = {1.0 / 1024, 1.0 / 8, 1, 1024};

TEST_P(MetamorphicTest, ContactNeitherLeaksNorDarkensAtAnyScale) {
    const auto contact = [](const std::string& technique, double scale) {
        return scaledRun(technique, contactScene(), scale, {3, 2, 1.5}, {0.5, 0.25, 0});
    };
    const auto rays = contact("raytrace", 1), plain = contact(GetParam(), 1);
    for (const double scale : kScales) {
        const auto found = contact(GetParam(), scale);
        expectKept("leak", differenceWhere(found, rays, 0));
        expectKept("acne", differenceWhere(found, rays, 1));
        expectKept("scale", differenceOf(plain, found));
    }
}

/// What of the light comes into a closed box.
Difference lightInBox(const std::string& technique, double scale,
                      const SettingValues& settings = {}) {
    SceneBuilder builder;
    builder.addQuad({-0.9F, -0.5F, 0.9F}, {1.8F, 0, 0}, {0, 0, -1.8F}, false);
    builder.addBox({-1, -1, -1}, {1, 1, 1});
    const auto inside =
        scaledRun(technique, builder.scene(), scale, {0.1, 0.5, 0.8}, {0, -0.5, 0}, settings);
    Difference leak;
    for (std::size_t i = 0; i < inside.pixels(); ++i)
        if (inside.tested(i)) leak.add(inside.visibility[i]);
    return leak;
}

TEST_P(MetamorphicTest, InsideAClosedBoxThereIsNoLightAtAnyScale) {
    for (const double scale : kScales) expectKept("box", lightInBox(GetParam(), scale));
}

TEST(MetamorphicVwssTest, TwiceThePointsLeaveNoHolesInAClosedBox) {
    EXPECT_GT(lightInBox("vwss", 1).mean(), 0.001);  // the exception is still one
    EXPECT_EQ(lightInBox("vwss", 1, {{"vwss.density", "2"}}).largest, 0);
}

INSTANTIATE_TEST_SUITE_P(All, MetamorphicTest, testing::ValuesIn(shadowTechniques()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace penumbra::tests
