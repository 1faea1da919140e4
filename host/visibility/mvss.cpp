// SPDX-License-Identifier: MIT
#include "host/visibility/mvss.h"

namespace penumbra::visibility {

scene::AreaLight mvssLight(const scene::AreaLight& light, int maps, int seed) {
    scene::AreaLight own = light;
    scene::SampleChoice choice;
    choice.pattern = scene::Pattern::poisson;
    choice.count = maps;
    choice.seed = static_cast<std::uint32_t>(seed);
    scene::placeSamples(choice, own);
    return own;
}

Mvss::Mvss(const TechniqueContext& context)
    : settings_(parseSettings<MvssSettings>("mvss", context.values)),
      shared_(context.device, "multi_view"),
      program_(context.device, "mvr"),
      multiView_(shared_, settings_, context.width, context.height, context.fragmentRows),
      source_(program_, {settings_.form, Coverage::standard, settings_.cull, true,
                         settings_.constantBias, settings_.slopeBias}),
      reader_(shared_, {Pcf::bilinear, {0, 0, 0}, true}) {}

std::uint64_t Mvss::plannedBytes(const TechniqueContext& context) {
    return MultiView::plannedBytes(parseSettings<MvssSettings>("mvss", context.values),
                                   context.width, context.height);
}

void Mvss::run(const Inputs& inputs, Visibility& visibility) {
    const auto light = mvssLight(inputs.light, settings_.maps, settings_.seed);
    multiView_.run(
        {inputs.mesh, inputs.gbuffer, light, inputs.casters, inputs.centre, inputs.depthMaps},
        light, source_, reader_, visibility);
}

Counts Mvss::takeCounts() {
    Counts counts = multiView_.takeCounts();
    counts.mapTriangles = source_.takeTriangles();
    return counts;
}

}  // namespace penumbra::visibility
