// SPDX-License-Identifier: MIT
#include "tests/fuzz/check_options.h"

#include "host/scene/light.h"
#include "host/visibility/essm.h"
#include "host/visibility/mlsm.h"
#include "host/visibility/mvr.h"
#include "host/visibility/mvss.h"
#include "host/visibility/none.h"
#include "host/visibility/pcss.h"
#include "host/visibility/raster4d.h"
#include "host/visibility/raytrace.h"
#include "host/visibility/vwss.h"
#include "tests/fuzz/expect_one_line.h"

namespace penumbra::fuzz {
namespace {

void checkSettings(const RenderOptions& options) {
    using namespace visibility;
    parseSettings<VwssSettings>("vwss", options.settings);
    parseSettings<MvrSettings>("mvr", options.settings);
    parseSettings<MvssSettings>("mvss", options.settings);
    parseSettings<PcssSettings>("pcss", options.settings);
    parseSettings<EssmSettings>("essm", options.settings);
    parseSettings<MlsmSettings>("mlsm", options.settings);
    parseSettings<Raster4dSettings>("raster4d", options.settings);
    parseSettings<RaytraceSettings>("raytrace", options.settings);
    parseSettings<NoSettings>("none", options.settings);
}

void checkLights(const RenderOptions& options) {
    scene::Scene scene;
    for (const auto& text : options.lights) scene.lights.push_back(scene::parseLight(text));
    scene::Bounds bounds;
    bounds.add({-1, 0, -1});
    bounds.add({1, 2, 1});
    scene::SampleChoice choice;
    choice.pattern = scene::parsePattern(options.lightPattern);
    choice = scene::parseSampleCount(options.lightSamples, choice);
    choice.seed = scene::parseSeed(options.seed, 0);
    if (choice.pattern == scene::Pattern::poisson) choice.count = 1;  // slow beside the rest
    for (const auto& light : scene::lightsAt(scene, {}, bounds, choice)) {
        const auto& z = light.axisZ;
        expect(std::abs(glm::length(z) - 1) < 1e-6, "a light with a direction");
        scene::facingIrradiance(light, bounds.centre());
    }
}

}  // namespace

void checkOptions(const RenderOptions& options) {
    if (!options.settings.empty()) checkSettings(options);
    checkLights(options);
}

}  // namespace penumbra::fuzz
