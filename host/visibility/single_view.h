// SPDX-License-Identifier: MIT
// The one view of techniques that look from the light's centre alone.
#pragma once
#include "host/scene/light.h"

namespace penumbra::visibility {

/// The light with its centre as its only sample: its size still says which receivers its views hold.
inline scene::AreaLight centralView(const scene::AreaLight& light) {
    scene::AreaLight central = light;
    central.samples = {glm::dvec2(0)};
    return central;
}

}  // namespace penumbra::visibility
