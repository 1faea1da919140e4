// SPDX-License-Identifier: MIT
// Which closed meshes have something inside, so that both of their faces matter.
#pragma once
#include <vector>

#include "host/scene/scene.h"

namespace penumbra::geometry {

/// [node]: true if the node's mesh is closed (`closed` [mesh]) and another node's mesh that
/// receives shadows lies in it at the clip's start: within its bounds, with the middle of its own
/// bounds inside. What moves in or out later changes nothing: shadows would jump.
std::vector<bool> findEnclosing(const scene::Scene& scene, const std::vector<bool>& closed);

/// Times that a closed surface goes round a point: the sum of its triangles' solid angles in whole
/// turns. `corners`: three a triangle.
double windingNumber(const std::vector<glm::dvec3>& corners, const glm::dvec3& point);

}  // namespace penumbra::geometry
