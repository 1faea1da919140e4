// SPDX-License-Identifier: MIT
// Twin of kernels/geometry/pose.cl in double, written from the glTF 2.0 specification.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/animation.h"
#include "host/scene/scene.h"

namespace penumbra::tests {

struct PosedVertices {
    std::vector<glm::dvec3> positions, normals;  ///< world; unit normals
};

/// Vertices of a primitive of a node. Morph targets add weighted displacements (3.7.2.2); skins
/// move by the weighted sum of joint matrices, without the node's own (3.7.3.3); normals by the
/// inverse transpose.
PosedVertices poseReference(const scene::Scene& scene, const scene::Pose& pose, int node,
                            const scene::Primitive& primitive);

/// A triangle of the posed scene, in drawing order.
struct PosedTriangle {
    glm::dvec3 corners[3];
    int node = 0;
    int primitive = 0;
    std::uint32_t indices[3] = {0, 0, 0};  ///< of the primitive's vertices
};

/// All triangles of the chosen scene in the order in which the geometry pass lists them.
std::vector<PosedTriangle> posedTriangles(const scene::Scene& scene, const scene::Pose& pose);

}  // namespace penumbra::tests
