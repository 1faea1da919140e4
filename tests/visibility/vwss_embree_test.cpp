// SPDX-License-Identifier: MIT
// View-warped soft shadows against ray-traced ones, to the same light samples, over small scenes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "host/scene/builtin.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/embree_scene.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using Settings = SettingValues;

/// Root mean square error against rays; prints it, so that it can be quoted.
double error(const char* what, const scene::Scene& scene, const ShadowSetup& setup) {
    const auto run = runShadows(scene, setup);
    const double value = rmse(run, tracedVisibility(scene, run));
    std::string settings;
    for (const auto& [key, text] : setup.settings) settings += " " + key + "=" + text;
    std::printf("[ RMSE     ] %s, %s samples%s: %.4f\n", what, setup.samples.c_str(),
                settings.c_str(), value);
    ::testing::Test::RecordProperty(std::string(what) + settings, std::to_string(value));
    return value;
}

double errorAt(const char* what, const scene::Scene& scene, ShadowSetup setup, const Settings& settings) {
    for (const auto& [key, text] : settings) setup.settings[key] = text;
    return error(what, scene, setup);
}

/// Mean of |1 - visibility| over pixels where rays see the whole light.
double meanLitError(const scene::Scene& scene, const ShadowSetup& setup) {
    const auto run = runShadows(scene, setup);
    const auto truth = tracedVisibility(scene, run);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i)
        if (run.tested(i) && truth[i] == 1) sum += 1 - static_cast<double>(run.visibility[i]), ++count;
    EXPECT_GT(count, 1000U);
    return sum / static_cast<double>(std::max<std::size_t>(count, 1));
}

constexpr float kBlockerHeight = 1.5F, kLightHeight = 4;
constexpr double kLightSize = 1;

/// A floor at y = 0 half covered, x < 0, by a sheet above it; the light hangs over the sheet's edge.
scene::Scene edgeScene() {
    SceneBuilder builder;
    builder.addQuad({-1.2F, 0, 1}, {2.4F, 0, 0}, {0, 0, -2}, false);
    builder.addQuad({-3, kBlockerHeight, 2}, {3, 0, 0}, {0, 0, -4});
    builder.material().doubleSided = true;
    return builder.scene();
}

ShadowSetup edgeSetup() {
    ShadowSetup setup;
    setup.light = "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1";
    setup.eye = {1.2, 1, 2.2};
    return setup;
}

/// Share of the light that a floor point sees past the edge at x = 0.
double edgeVisibility(double x) {
    const double first = x * (1 - kLightHeight / kBlockerHeight);
    return std::clamp((kLightSize / 2 - first) / kLightSize, 0.0, 1.0);
}

ShadowSetup overheadSetup() {
    ShadowSetup setup;
    setup.light = "rect:at=0.6,5,0.8;aim=0,0,0;size=1x1";
    setup.eye = {1, 3, 4};
    return setup;
}

scene::Scene sphereScene() {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    builder.addSphere({0, 0.9F, 0}, 0.6F);
    return builder.scene();
}

scene::Scene staffScene() {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    builder.addBox({-0.02F, 0.3F, -0.02F}, {0.02F, 2.3F, 0.02F});
    return builder.scene();
}

ShadowSetup staffSetup() {
    ShadowSetup setup;
    setup.light = "rect:at=0,5,0;aim=0,0,0;up=0,0,1;size=1x1";
    setup.eye = {0.8, 1.5, 1.6};
    return setup;
}

ShadowSetup builtinSetup() {
    ShadowSetup setup;
    setup.placedCamera = false;
    return setup;
}

TEST(VwssEmbree, PenumbraOfAnEdgeFollowsTheClosedForm) {
    auto setup = edgeSetup();
    setup.samples = "256";
    const auto run = runShadows(edgeScene(), setup);
    double sum = 0, worst = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const glm::dvec3 p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
        if (!run.tested(i) || std::abs(p.y) > 1e-3) continue;
        const double difference = std::abs(run.visibility[i] - edgeVisibility(p.x));
        sum += difference;
        worst = std::max(worst, difference);
        ++count;
    }
    ASSERT_GT(count, 3000U);
    std::printf("[ EDGE     ] mean %.5f worst %.5f\n", sum / static_cast<double>(count), worst);
    EXPECT_LT(sum / static_cast<double>(count), 0.005);
    EXPECT_LT(worst, 0.03);
}

TEST(VwssEmbree, ErrorFallsWithResolution) {
    const struct {
        const char* name;
        scene::Scene scene;
        ShadowSetup setup;
        double limits[3];
    } cases[] = {{"edge", edgeScene(), edgeSetup(), {1, 1, 1}},
                 {"sphere", sphereScene(), overheadSetup(), {1, 1, 1}},
                 {"staff", staffScene(), staffSetup(), {1, 1, 1}},
                 {"built-in", scene::loadBuiltinScene(), builtinSetup(), {1, 1, 1}}};
    for (const auto& c : cases) {
        double last = 1;
        const char* const resolutions[] = {"256", "512", "1024"};
        for (int i = 0; i < 3; ++i) {
            const double value =
                errorAt(c.name, c.scene, c.setup, {{"vwss.resolution", resolutions[i]}});
            EXPECT_LT(value, c.limits[i]) << c.name << " at " << resolutions[i];
            EXPECT_LT(value, last) << c.name << " at " << resolutions[i];
            last = value;
        }
    }
}

TEST(VwssEmbree, KeepingBackFacesCostsPointsAndLowersTheErrorOfASphere) {
    const auto scene = sphereScene();
    for (const char* cull : {"auto", "back", "none", "front"})
        errorAt("sphere", scene, overheadSetup(), {{"vwss.resolution", "512"}, {"vwss.cull", cull}});
    for (const char* cull : {"auto", "back", "none", "front"})
        errorAt("staff", staffScene(), staffSetup(),
                {{"vwss.resolution", "512"}, {"vwss.cull", cull}});
    for (const char* cull : {"auto", "back", "none", "front"})
        errorAt("built-in", scene::loadBuiltinScene(), builtinSetup(),
                {{"vwss.resolution", "512"}, {"vwss.cull", cull}});
}

TEST(VwssEmbree, ErrorFallsWithDensity) {
    for (const char* density : {"0.5", "1", "2"}) {
        errorAt("sphere", sphereScene(), overheadSetup(),
                {{"vwss.resolution", "512"}, {"vwss.density", density}});
        errorAt("staff", staffScene(), staffSetup(),
                {{"vwss.resolution", "512"}, {"vwss.density", density}});
        errorAt("built-in", scene::loadBuiltinScene(), builtinSetup(),
                {{"vwss.resolution", "512"}, {"vwss.density", density}});
    }
}

TEST(VwssEmbree, FlatTiltedAndRoundSurfacesDoNotShadowThemselves) {
    SceneBuilder flat;
    flat.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    SceneBuilder tilted;
    tilted.addQuad({-1.5F, -1, 1.5F}, {3, 0, 0}, {0, 2, -3});
    SceneBuilder sphere;
    sphere.addSphere({0, 0, 0}, 1);
    for (const char* pcf : {"1", "5", "9", "bilinear"}) {
        auto setup = overheadSetup();
        setup.settings["vwss.pcf"] = pcf;
        const double f = meanLitError(flat.scene(), setup), t = meanLitError(tilted.scene(), setup),
                     s = meanLitError(sphere.scene(), setup);
        setup.settings["vwss.cull"] = "none";
        const double n = meanLitError(sphere.scene(), setup);
        std::printf("[ ACNE     ] pcf %s flat %.5f tilted %.5f sphere %.5f sphere cull none %.5f\n", pcf, f, t, s, n);
        EXPECT_LT(f, 0.002);
        EXPECT_LT(t, 0.002);
        EXPECT_LT(s, 0.002);
    }
}

}  // namespace
}  // namespace penumbra::tests
