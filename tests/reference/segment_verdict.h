// SPDX-License-Identifier: MIT
// Whether triangles hide a segment, in double, every triangle in turn; and what rounding may
// change.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace penumbra::tests {

/// What can be said of a segment if all coordinates may be off by `tolerance` metres.
enum class Verdict { open, hidden, graze };

/// `corners`: three a triangle.
Verdict segmentVerdict(const std::vector<glm::vec3>& corners, const glm::dvec3& from,
                       const glm::dvec3& to, double tolerance);

}  // namespace penumbra::tests
