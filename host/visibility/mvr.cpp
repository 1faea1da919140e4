// SPDX-License-Identifier: MIT
#include "host/visibility/mvr.h"

namespace penumbra::visibility {

Mvr::Mvr(const TechniqueContext& context)
    : settings_(parseSettings<MvrSettings>("mvr", context.values)),
      shared_(context.device, "multi_view"),
      program_(context.device, "mvr"),
      multiView_(shared_, settings_, context.width, context.height, context.fragmentRows),
      source_(program_, {settings_.form, settings_.coverage, settings_.cull}),
      reader_(shared_, {settings_.pcf, settings_, false}) {}

std::uint64_t Mvr::plannedBytes(const TechniqueContext& context) {
    return MultiView::plannedBytes(parseSettings<MvrSettings>("mvr", context.values), context.width,
                                   context.height);
}

Counts Mvr::takeCounts() {
    Counts counts = multiView_.takeCounts();
    counts.mapTriangles = source_.takeTriangles();
    return counts;
}

}  // namespace penumbra::visibility
