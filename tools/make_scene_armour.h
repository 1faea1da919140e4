// SPDX-License-Identifier: MIT
// Plates over the figure's body, and helmets.
#pragma once

#include "make_scene_mesh.h"

namespace tools {

// Distance to the plates in the figure's space at rest, given that to the bare torso.
float armourDistance(const glm::vec3& p, float torso);

enum class Helmet { crested, horned, spiked };

// Closed, around the head joint;
Mesh makeHelmet(Helmet kind, size_t triangleCount);

}  // namespace tools
