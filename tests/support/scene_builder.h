// SPDX-License-Identifier: MIT
// Scenes made in code, of triangles with flat normals.
#pragma once
#include <vector>

#include "host/scene/scene.h"

namespace penumbra::tests {

/// Scenes in code: a mesh becomes a node with the given transform.
class SceneBuilder {
  public:
    SceneBuilder();
    /// Adds triangles in the world; `positions` per vertex, three indices per triangle. Returns the
    /// node.
    int addMesh(const std::vector<glm::vec3>& positions, const std::vector<std::uint32_t>& indices,
                const glm::dmat4& world = glm::dmat4(1), bool casts = true, bool receives = true);
    /// Rectangle spanned by two edges from a corner; front along cross(a, b).
    int addQuad(glm::vec3 corner, glm::vec3 a, glm::vec3 b, bool casts = true,
                bool receives = true);
    /// Closed sphere of quads, normals outwards.
    int addSphere(glm::vec3 centre, float radius, int rings = 32, int segments = 64);
    /// Closed box.
    int addBox(glm::vec3 low, glm::vec3 high);
    scene::Material& material() { return scene_.materials[0]; }
    scene::Scene& scene() { return scene_; }

  private:
    scene::Scene scene_;
};

}  // namespace penumbra::tests
