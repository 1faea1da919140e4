// SPDX-License-Identifier: MIT
#include "tests/reference/segment_verdict.h"

#include <algorithm>
#include <limits>

namespace penumbra::tests {
namespace {

/// How far the segment passes inside of a triangle: the least distance, in metres, from the
/// segment's line to the edges' lines and from its ends to the plane; negative outside.
double depthInside(const glm::dvec3 v[3], const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 d = to - from;
    const glm::dvec3 normal = glm::cross(v[1] - v[0], v[2] - v[0]);
    const double area = glm::length(normal), side = glm::dot(normal, d) >= 0 ? 1 : -1;
    if (area <= 0) return -std::numeric_limits<double>::infinity();
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 a = v[k] - from, e = v[(k + 1) % 3] - v[k];
        const glm::dvec3 across = glm::cross(a, e);
        const double apart = glm::length(glm::cross(d, e));
        if (apart <= 0) return -std::numeric_limits<double>::infinity();
        least = std::min(least, side * glm::dot(across, d) / apart);
    }
    const double start = side * glm::dot(normal, v[0] - from) / area;
    const double stop = side * glm::dot(normal, to - v[0]) / area;
    return std::min({least, start, stop});
}

}  // namespace

Verdict segmentVerdict(const std::vector<glm::vec3>& corners, const glm::dvec3& from,
                       const glm::dvec3& to, double tolerance) {
    bool graze = false;
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
        const glm::dvec3 v[3] = {corners[t], corners[t + 1], corners[t + 2]};
        const double depth = depthInside(v, from, to);
        if (depth > tolerance) return Verdict::hidden;
        graze = graze || depth > -tolerance;
    }
    return graze ? Verdict::graze : Verdict::open;
}

}  // namespace penumbra::tests
