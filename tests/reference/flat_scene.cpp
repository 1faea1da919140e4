// SPDX-License-Identifier: MIT
#include "tests/reference/flat_scene.h"

#include <cmath>

namespace penumbra::tests {

std::vector<FlatTriangle> flatTriangles(const scene::Scene& scene) {
    std::vector<FlatTriangle> triangles;
    for (const int index : scene.order) {
        const auto& node = scene.nodes[static_cast<std::size_t>(index)];
        if (node.mesh < 0) continue;
        for (const auto& p : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives)
            for (std::size_t t = 0; t + 2 < p.indices.size(); t += 3) {
                FlatTriangle flat;
                flat.primitive = &p;
                flat.material = &scene.materials[static_cast<std::size_t>(p.material)];
                flat.worldFromNode = node.matrix;
                flat.object = static_cast<std::uint32_t>(index) + 1;
                for (std::size_t i = 0; i < 3; ++i) {
                    flat.vertex[i] = p.indices[t + i];
                    flat.corner[i] = glm::dvec3(
                        node.matrix * glm::dvec4(glm::dvec3(p.positions[flat.vertex[i]]), 1));
                }
                triangles.push_back(flat);
            }
    }
    return triangles;
}

SightLine sightLine(const scene::CameraFrame& camera, int width, int height, double column,
                    double row) {
    const double right = 2 * column / width - 1, up = 1 - 2 * row / height;
    const glm::dmat3 axes(camera.worldFromCamera);
    const glm::dvec3 eye(camera.worldFromCamera[3]);
    if (camera.orthographic)
        return {eye + axes * glm::dvec3(right * camera.xmag, up * camera.ymag, 0), -axes[2]};
    const double t = std::tan(camera.yfovRad / 2);
    return {eye, axes * glm::dvec3(right * t * width / height, up * t, -1)};
}

PlaneHit hitPlane(const FlatTriangle& triangle, const SightLine& line) {
    const auto& [a, b, c] = triangle.corner;
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    PlaneHit hit;
    hit.depth = glm::dot(a - line.origin, normal) / glm::dot(line.direction, normal);
    hit.position = line.origin + hit.depth * line.direction;
    const double area = glm::dot(normal, normal);
    hit.weights.x = glm::dot(glm::cross(b - hit.position, c - hit.position), normal) / area;
    hit.weights.y = glm::dot(glm::cross(c - hit.position, a - hit.position), normal) / area;
    hit.weights.z = glm::dot(glm::cross(a - hit.position, b - hit.position), normal) / area;
    return hit;
}

}  // namespace penumbra::tests
