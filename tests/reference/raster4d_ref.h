// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/raster4d.cl: every triangle for every segment, in double, in the
// world's own coordinates; no grid, no sorting, no rows.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "tests/reference/shadow_run.h"

namespace penumbra::tests {

/// What can be said of a segment if all coordinates may be off by `tolerance` metres.
enum class Verdict { open, hidden, graze };

/// `corners`: three a triangle.
Verdict segmentVerdict(const std::vector<glm::vec3>& corners, const glm::dvec3& from,
                       const glm::dvec3& to, double tolerance);

/// Bit of a pixel and a light sample; cells without a sample are not hidden.
bool maskBit(const ShadowRun& run, std::size_t pixel, int row, int column);

/// How masks compare with the twin.
struct MaskAgreement {
    std::size_t bits = 0, hidden = 0, grazes = 0, wrong = 0;
};
MaskAgreement compareMasks(const ShadowRun& run, std::size_t pixelStep = 1);

}  // namespace penumbra::tests
