// SPDX-License-Identifier: MIT
// A posed scene in Embree: the truth for primary and shadow rays.
#pragma once
#include <embree3/rtcore.h>

#include <glm/glm.hpp>
#include <vector>

#include "tests/reference/pose_ref.h"
#include "tests/reference/shadow_run.h"

namespace penumbra::tests {

class EmbreeScene {
  public:
    /// `centre`: what coordinates are re-based to. castersOnly: without nodes that cast no shadows.
    EmbreeScene(const scene::Scene& scene, const scene::Pose& pose, const glm::dvec3& centre,
                bool castersOnly);
    /// Triangles as they are, three corners each.
    explicit EmbreeScene(const std::vector<glm::vec3>& corners);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    struct Hit {
        int triangle = -1;  ///< index into triangles(); -1: nothing
        float t = 0, u = 0, v = 0;
    };
    Hit trace(const glm::vec3& origin, const glm::vec3& direction, float nearest = 0) const;
    bool occluded(const glm::vec3& from, const glm::vec3& to) const;
    const std::vector<PosedTriangle>& triangles() const { return triangles_; }

  private:
    void commit(const std::vector<glm::vec3>& corners);
    std::vector<PosedTriangle> triangles_;
    RTCDevice device_ = nullptr;
    RTCScene scene_ = nullptr;
};

/// Share of the run's own light samples that each tested pixel sees; samples below the receiver's
/// geometric plane are hidden. `samples` replaces the light's own where it is not empty.
std::vector<float> tracedVisibility(const scene::Scene& scene, const ShadowRun& run,
                                    std::vector<glm::vec3> samples = {});

}  // namespace penumbra::tests
