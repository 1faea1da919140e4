// SPDX-License-Identifier: MIT
#include "tests/reference/raytrace_ref.h"

#include "kernels/shared/gbuffer.h"

namespace penumbra::tests {

bool segmentMeets(const glm::dvec3 corners[3], const glm::dvec3& from, const glm::dvec3& to,
                  glm::dvec3& barycentric) {
    // Cramer's rule for (t, u, v) of from - v0 = -t d + u a + v b
    const glm::dvec3 a = corners[1] - corners[0], b = corners[2] - corners[0], d = to - from;
    const glm::dvec3 s = from - corners[0];
    const double whole = glm::determinant(glm::dmat3(-d, a, b));
    if (whole == 0) return false;
    const double t = glm::determinant(glm::dmat3(s, a, b)) / whole;
    const double u = glm::determinant(glm::dmat3(-d, s, b)) / whole;
    const double v = glm::determinant(glm::dmat3(-d, a, s)) / whole;
    barycentric = {1 - u - v, u, v};
    return t > 0 && t < 1 && u >= 0 && v >= 0 && u + v <= 1;
}

RayReference::RayReference(const scene::Scene& scene, const scene::Pose& pose) : scene_(&scene) {
    for (const auto& triangle : posedTriangles(scene, pose))
        if (scene.nodes[static_cast<std::size_t>(triangle.node)].castShadow)
            casters_.push_back(triangle);
}

glm::dvec3 RayReference::transmittance(const glm::dvec3& from, const glm::dvec3& to) const {
    glm::dvec3 passed(1);
    for (const auto& triangle : casters_) {
        SurfacePoint point;
        if (!segmentMeets(triangle.corners, from, to, point.barycentric)) continue;
        point.vertices = {triangle.indices[0], triangle.indices[1], triangle.indices[2]};
        const auto mesh = scene_->nodes[static_cast<std::size_t>(triangle.node)].mesh;
        const auto& primitive = scene_->meshes[static_cast<std::size_t>(mesh)]
                                    .primitives[static_cast<std::size_t>(triangle.primitive)];
        passed *= transmittanceReference(*scene_, primitive, point);
        if (passed == glm::dvec3(0)) break;
    }
    return passed;
}

glm::dvec3 RayReference::visibility(const ShadowRun& run, std::size_t pixel) const {
    const glm::dvec3 origin = glm::dvec3(run.shadowOrigin(pixel)) + run.bounds.centre();
    const glm::dvec3 normal(run.vectorAt(GB_GEOMETRIC, pixel));
    glm::dvec3 sum(0);
    for (const auto& s : run.light.samples) {
        const glm::dvec3 sample = run.light.centre + s.x * run.light.axisX + s.y * run.light.axisY;
        if (glm::dot(sample - origin, normal) > 0) sum += transmittance(origin, sample);
    }
    return sum / static_cast<double>(run.light.samples.size());
}

}  // namespace penumbra::tests
