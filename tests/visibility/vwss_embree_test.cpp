// SPDX-License-Identifier: MIT
// View-warped soft shadows against ray-traced ones, to the same light samples, over small scenes.
#include <gtest/gtest.h>

#include <algorithm>
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

double errorAt(const char* what, const scene::Scene& scene, ShadowSetup setup,
               const Settings& settings) {
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
        if (run.tested(i) && truth[i] == 1)
            sum += 1 - static_cast<double>(run.visibility[i]), ++count;
    EXPECT_GT(count, 1000U);
    return sum / static_cast<double>(std::max<std::size_t>(count, 1));
}

constexpr float kBlockerHeight = 1.5F, kLightHeight = 4;
constexpr double kLightSize = 1;

/// A floor at y = 0 half covered, x < 0, by a sheet above it; the light hangs over the sheet's
/// edge.
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
    } cases[] = {{"edge", edgeScene(), edgeSetup(), {0.007, 0.0055, 0.0045}},
                 {"sphere", sphereScene(), overheadSetup(), {0.021, 0.017, 0.015}},
                 {"staff", staffScene(), staffSetup(), {0.034, 0.034, 0.033}},
                 {"built-in", scene::loadBuiltinScene(), builtinSetup(), {0.13, 0.09, 0.057}}};
    for (const auto& c : cases) {
        double errors[3];
        const char* const resolutions[] = {"256", "512", "1024"};
        for (int i = 0; i < 3; ++i) {
            errors[i] = errorAt(c.name, c.scene, c.setup, {{"vwss.resolution", resolutions[i]}});
            EXPECT_LT(errors[i], c.limits[i]) << c.name << " at " << resolutions[i];
        }
        // A staff along the light's axis is nothing but steep faces: there resolution gains little
        EXPECT_LT(errors[1], 1.01 * errors[0]) << c.name;
        EXPECT_LT(errors[2], errors[1]) << c.name;
    }
}

TEST(VwssEmbree, KeepingBackFacesMakesMorePointsAndLessError) {
    const struct {
        const char* name;
        scene::Scene scene;
        ShadowSetup setup;
        double least;  ///< error with cull=none, relative to cull=back
    } cases[] = {{"sphere", sphereScene(), overheadSetup(), 0.7},
                 {"staff", staffScene(), staffSetup(), 0.85}};
    for (const auto& c : cases) {
        auto back = c.setup, none = c.setup;
        back.settings["vwss.cull"] = "back";
        none.settings["vwss.cull"] = "none";
        EXPECT_LT(error(c.name, c.scene, none), c.least * error(c.name, c.scene, back)) << c.name;
        EXPECT_GT(runShadows(c.scene, none).counts.points, runShadows(c.scene, back).counts.points)
            << c.name;
    }
}

TEST(VwssEmbree, AutomaticCullingDropsBackFacesOfClosedMeshesOnly) {
    const auto points = [](const scene::Scene& scene, const char* cull) {
        ShadowSetup setup = overheadSetup();
        setup.settings["vwss.cull"] = cull;
        return runShadows(scene, setup).counts.points;
    };
    SceneBuilder closed;
    closed.addSphere({0, 0, 0}, 1);
    EXPECT_EQ(points(closed.scene(), "auto"), points(closed.scene(), "back"));
    EXPECT_LT(points(closed.scene(), "auto"), points(closed.scene(), "none"));
    SceneBuilder open;
    open.addQuad({-1, 0, -1}, {2, 0, 0}, {0, 0, 2});  // its front looks down, away from the light
    EXPECT_EQ(points(open.scene(), "auto"), points(open.scene(), "none"));
    EXPECT_EQ(points(open.scene(), "back"), 0U);
    EXPECT_GT(points(open.scene(), "auto"), 0U);
}

// Beyond density 1 thin things grow: any point in a texel blocks all of it. So only smooth casters
// gain.
TEST(VwssEmbree, ErrorFallsWithDensity) {
    const auto at = [](const char* name, const scene::Scene& scene, const ShadowSetup& setup,
                       const char* density) {
        return errorAt(name, scene, setup, {{"vwss.resolution", "512"}, {"vwss.density", density}});
    };
    const auto sphere = sphereScene(), builtin = scene::loadBuiltinScene(), staff = staffScene();
    const double half = at("sphere", sphere, overheadSetup(), "0.5");
    const double one = at("sphere", sphere, overheadSetup(), "1");
    EXPECT_LT(one, 0.2 * half);
    EXPECT_LT(at("sphere", sphere, overheadSetup(), "2"), 0.85 * one);
    EXPECT_LT(at("staff", staff, staffSetup(), "2"), at("staff", staff, staffSetup(), "0.5"));
    EXPECT_LT(at("built-in", builtin, builtinSetup(), "1"),
              0.5 * at("built-in", builtin, builtinSetup(), "0.5"));
    EXPECT_LT(at("built-in", builtin, builtinSetup(), "2"), 0.13);
}

TEST(VwssEmbree, ErrorAgainstTheWholeLightFallsWithTheNumberOfViews) {
    const auto scene = sphereScene();
    auto setup = overheadSetup();
    setup.samples = "1024";
    setup.settings["vwss.resolution"] = "64";  // only its samples are of use
    const auto dense = runShadows(scene, setup).samplePoints();
    setup.settings["vwss.resolution"] = "1024";
    double last = 1;
    for (const char* samples : {"4", "16", "64", "256"}) {
        setup.samples = samples;
        const auto run = runShadows(scene, setup);
        const double value = rmse(run, tracedVisibility(scene, run, dense));
        std::printf("[ RMSE     ] sphere, %s samples against 1024: %.4f\n", samples, value);
        EXPECT_LT(value, last) << samples;
        last = value;
    }
    EXPECT_LT(last, 0.015);
}

TEST(VwssEmbree, FlatTiltedAndRoundSurfacesDoNotShadowThemselves) {
    SceneBuilder flat, tilted, sphere;
    flat.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4});
    tilted.addQuad({-1.5F, -1, 1.5F}, {3, 0, 0}, {0, 2, -3});
    sphere.addSphere({0, 0, 0}, 1);
    for (const char* cull : {"auto", "none"})
        for (const char* pcf : {"1", "5", "9", "bilinear"}) {
            auto setup = overheadSetup();
            setup.settings = {{"vwss.pcf", pcf}, {"vwss.cull", cull}, {"vwss.resolution", "512"}};
            EXPECT_LT(meanLitError(flat.scene(), setup), 0.002) << pcf << ' ' << cull;
            EXPECT_LT(meanLitError(tilted.scene(), setup), 0.002) << pcf << ' ' << cull;
            EXPECT_LT(meanLitError(sphere.scene(), setup), 0.002) << pcf << ' ' << cull;
        }
}

TEST(VwssEmbree, AFloorAtGrazingLightIsAsLitAsTheLightIsAboveIt) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    for (const char* pcf : {"1", "5", "9", "bilinear"}) {
        ShadowSetup setup;
        setup.light = "rect:at=6,0.15,0;aim=0,0,0;size=1x1";
        setup.eye = {1, 2, 2};
        setup.settings = {{"vwss.pcf", pcf}, {"vwss.resolution", "256"}};
        const auto run = runShadows(builder.scene(), setup);
        const auto truth = tracedVisibility(builder.scene(), run);
        EXPECT_LT(rmse(run, truth), 1e-4) << pcf;
        const auto middle = run.pixels() / 2 + static_cast<std::size_t>(run.width) / 2;
        EXPECT_NEAR(truth[middle], 0.65, 0.1);  // a third of the light is below the floor
    }
}

TEST(VwssEmbree, WithoutBiasAFloorWouldShadowItself) {
    SceneBuilder tilted;
    tilted.addQuad({-1.5F, -1, 1.5F}, {3, 0, 0}, {0, 2, -3});
    auto setup = overheadSetup();
    setup.settings = {{"vwss.constantBias", "0"}, {"vwss.slopeBias", "0"}};
    EXPECT_GT(meanLitError(tilted.scene(), setup), 0.02);
}

/// Floor pixels below a box's foot, column by column, that are lit although the box hides the
/// light.
TEST(VwssEmbree, ShadowOfABoxBeginsWithinTwoPixelsOfItsFoot) {
    SceneBuilder builder;
    builder.addQuad({-3, 0, 3}, {6, 0, 0}, {0, 0, -6});
    builder.addBox({-0.5F, 0, -0.5F}, {0.5F, 1, 0.5F});
    ShadowSetup setup;
    setup.light = "rect:at=-3,4,0;aim=0,0,0;size=0.5x0.5";
    setup.eye = {4, 2, 0};
    setup.target = {0.5, 0.2, 0};
    setup.width = 320;
    setup.height = 240;
    const auto run = runShadows(builder.scene(), setup);
    const auto truth = tracedVisibility(builder.scene(), run);
    const auto onFloor = [&](std::size_t i) {
        return run.tested(i) && run.vectorAt(GB_GEOMETRIC, i).y > 0.9F;
    };
    int columns = 0, widest = 0;
    for (int x = 0; x < run.width; ++x) {
        int gap = 0;
        bool foot = false;
        for (int y = 1; y < run.height; ++y) {
            const auto i = static_cast<std::size_t>(y * run.width + x);
            const glm::dvec3 p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
            const auto above = i - static_cast<std::size_t>(run.width);
            if (onFloor(i) && !onFloor(above) && std::abs(p.z) < 0.45 && p.x > 0.5)
                foot = true, ++columns;
            if (!foot) continue;
            if (truth[i] > 0.05F || run.visibility[i] < 0.5F) break;
            ++gap;
        }
        widest = std::max(widest, gap);
    }
    std::printf("[ CONTACT  ] gap %d pixels over %d columns\n", widest, columns);
    EXPECT_GT(columns, 50);
    EXPECT_LE(widest, 2);
}

}  // namespace
}  // namespace penumbra::tests
