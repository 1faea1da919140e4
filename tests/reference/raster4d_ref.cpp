// SPDX-License-Identifier: MIT
#include "tests/reference/raster4d_ref.h"

#include <algorithm>
#include <limits>

#include "kernels/shared/gbuffer.h"

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

bool maskBit(const ShadowRun& run, std::size_t pixel, int row, int column) {
    const auto& masks = run.masks;
    const auto plane = static_cast<std::size_t>(row * masks.words() + column / 32);
    return masks.bits[plane * masks.stride + pixel] >> (column % 32) & 1U;
}

MaskAgreement compareMasks(const ShadowRun& run, std::size_t pixelStep) {
    MaskAgreement result;
    const double tolerance = 1e-6 * std::max(run.bounds.empty ? 0 : run.bounds.radius(), 1e-30);
    const auto points = run.samplePoints();
    for (std::size_t i = 0; i < run.pixels(); i += pixelStep) {
        if (!run.tested(i)) continue;
        const glm::dvec3 origin = run.shadowOrigin(i), normal = run.vectorAt(GB_GEOMETRIC, i);
        for (int row = 0; row < run.masks.rows; ++row)
            for (int column = 0; column < run.masks.columns; ++column) {
                const int sample =
                    run.masks.samples[static_cast<std::size_t>(row * run.masks.columns + column)];
                if (sample < 0) continue;
                const glm::dvec3 point = points[static_cast<std::size_t>(sample)];
                const double height = glm::dot(point - origin, normal);
                Verdict verdict = Verdict::hidden;
                if (height > -tolerance) verdict = segmentVerdict(run.casters, origin, point, tolerance);
                if (std::abs(height) <= tolerance && verdict == Verdict::open)
                    verdict = Verdict::graze;
                const bool hidden = maskBit(run, i, row, column);
                ++result.bits;
                result.hidden += hidden;
                result.grazes += verdict == Verdict::graze;
                result.wrong += verdict != Verdict::graze && hidden != (verdict == Verdict::hidden);
            }
    }
    return result;
}

}  // namespace penumbra::tests
