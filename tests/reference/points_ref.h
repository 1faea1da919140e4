// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/points.cl in double: for every caster the pixels of the enlarged view
// whose centres it covers ([VWSS] 3.1), the ray of each pixel cut with the triangle's plane, and
// the point as the light's views see it (kernels/shared/multi_view.h).
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/animation.h"
#include "host/scene/light.h"
#include "host/visibility/light_view.h"
#include "host/visibility/points.h"

namespace penumbra::tests {

struct PointReference {
    double a = 0, b = 0, w = 0;
    double opacity = 1;       ///< 0, 1]: blended surfaces: alpha (1 - transmission)
    int draw = 0;             ///< counts the primitives of nodes in the scene's order
    int column = 0, row = 0;  ///< pixel of the enlarged view
    double slackW = 0;        ///< what snapping vertices to 1/256 pixel and float may move w by
    double slackA = 0, slackB = 0;
};

/// All points, in no order. `closed` tells whether a node's mesh is closed, which automatic culling
/// asks for.
std::vector<PointReference> pointsReference(const scene::Scene& scene, const scene::Pose& pose,
                                            const scene::AreaLight& light,
                                            const visibility::LightView& view,
                                            visibility::Cull cull,
                                            const std::function<bool(int node)>& closed);

}  // namespace penumbra::tests
