// SPDX-License-Identifier: MIT
// Bounds of all casters over the whole clip: camera, light fit, near plane, ground and automatic
// bias come from these, so that a frame does not depend on which others were asked for.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/animation.h"
#include "host/scene/scene.h"

namespace penumbra::scene {

struct Bounds {
    glm::dvec3 low{0}, high{0};  ///< world, metres
    bool empty = true;
    glm::dvec3 centre() const { return 0.5 * (low + high); }         ///< C
    double radius() const { return 0.5 * glm::length(high - low); }  ///< R
    void add(const glm::dvec3& point);
};

/// World positions of a primitive of a node under a pose, in double: morphed, then skinned or
/// moved.
std::vector<glm::dvec3> posedPositions(const Scene& scene, const Pose& pose, int node,
                                       const Primitive& primitive);

/// Bounds of the nodes that cast shadows, at the clip's frames (24 a second, at most 240). Where
/// none casts, of all nodes. Vertices that are not finite are left out.
Bounds clipBounds(const Scene& scene, const std::vector<int>& clips);

/// Adds a square of side 20 R under the bounds (at the lowest point less 1e-4 R): albedo 0.5,
/// rough, receives only.
void addGround(Scene& scene, const Bounds& bounds);

}  // namespace penumbra::scene
