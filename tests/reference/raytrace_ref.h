// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/raytrace.cl: every triangle for every ray, in double, in the world's
// own coordinates; no tree, no packets, no logarithms.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "tests/reference/pose_ref.h"
#include "tests/reference/shadow_run.h"
#include "tests/reference/surface_ref.h"

namespace penumbra::tests {

/// Solves from + t (to - from) = v0 + u (v1 - v0) + v (v2 - v0). False where the segment is
/// parallel to the triangle, misses it, or meets it at an end.
bool segmentMeets(const glm::dvec3 corners[3], const glm::dvec3& from, const glm::dvec3& to,
                  glm::dvec3& barycentric);

class RayReference {
  public:
    RayReference(const scene::Scene& scene, const scene::Pose& pose);
    /// Product of what the casters along the open segment let through, per channel.
    glm::dvec3 transmittance(const glm::dvec3& from, const glm::dvec3& to) const;
    /// Mean over the run's light samples of what reaches a pixel; samples below the horizon of its
    /// geometric normal give nothing.
    glm::dvec3 visibility(const ShadowRun& run, std::size_t pixel) const;

  private:
    const scene::Scene* scene_;
    std::vector<PosedTriangle> casters_;
};

}  // namespace penumbra::tests
