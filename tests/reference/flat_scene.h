// SPDX-License-Identifier: MIT
// What the twins of the G-buffer see of a scene: its triangles in the world and lines of sight, in
// double precision and without matrices of the device.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace penumbra::tests {

/// A triangle of a scene at rest. It points into the scene.
struct FlatTriangle {
    std::array<glm::dvec3, 3> corner;  ///< world
    std::array<std::uint32_t, 3> vertex{};
    const scene::Primitive* primitive = nullptr;
    const scene::Material* material = nullptr;
    glm::dmat4 worldFromNode{1};
    std::uint32_t object = 0;  ///< node + 1
};

/// All triangles in the order of the device's: nodes, their primitives, their triangles. Nodes must
/// be roots with matrices.
std::vector<FlatTriangle> flatTriangles(const scene::Scene& scene);

/// A line of sight; `direction` has length 1 along the camera's axis, so that the point at
/// origin + t direction has camera depth t.
struct SightLine {
    glm::dvec3 origin, direction;
};

/// The line through image position (column, row), in pixels: the centre of pixel (0, 0) is (0.5,
/// 0.5).
SightLine sightLine(const scene::CameraFrame& camera, int width, int height, double column,
                    double row);

/// Where a line of sight meets a triangle's plane.
struct PlaneHit {
    double depth = 0;  ///< camera depth, metres; <= 0: behind the camera
    glm::dvec3 position{0};
    glm::dvec3 weights{0};  ///< barycentric, by areas; sum 1; negative outside
};
PlaneHit hitPlane(const FlatTriangle& triangle, const SightLine& line);

}  // namespace penumbra::tests
