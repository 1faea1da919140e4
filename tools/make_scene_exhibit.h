// SPDX-License-Identifier: MIT
// A scene of [4DR]: what stands on a square ground, of a given diagonal, before a square light at
// a given distance from the scene's centre.
#pragma once

#include <string_view>

#include "make_scene_stage.h"

namespace tools {

// What [4DR] section 4 tells of a scene (its unit is ours, the metre), and the view of it.
struct ExhibitView {
    float diagonal;          // of the bounds of all, the ground included
    float lightDistance;     // from the centre of these bounds to the light's
    glm::vec3 towardsLight;  // any length
    glm::vec3 eye, target;
    float yfovDeg;
    glm::vec3 groundColour;
};

class Exhibit {
  public:
    explicit Exhibit(GltfWriter& writer) : writer_(writer) {}

    // Adds a part that stands where it is modelled; `isSheet`: seen from both sides.
    void add(std::string_view name, const Mesh& mesh, const glm::vec3& colour,
             float roughness = 0.9F, bool isSheet = false);

    // Counts a part that was added to the writer itself and stays below `height`.
    void count(size_t triangles, float height);

    // What is left to add of a number of triangles, the ground taken into account.
    size_t trianglesLeft(size_t total) const { return total - triangleCount_ - 2; }

    // Adds ground, light and camera. Throws std::runtime_error where the parts do not fit into the
    // diagonal.
    void finish(const ExhibitView& view);

  private:
    GltfWriter& writer_;
    size_t triangleCount_ = 0;
    glm::vec3 low_{0}, high_{0};
};

}  // namespace tools
