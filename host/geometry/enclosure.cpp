// SPDX-License-Identifier: MIT
// Solid angle of a triangle: A. van Oosterom, J. Strackee, The Solid Angle of a Plane Triangle,
// IEEE Transactions on Biomedical Engineering 30(2), 1983.
#include "host/geometry/enclosure.h"

#include <algorithm>
#include <cmath>

#include "host/scene/animation.h"
#include "host/scene/bounds.h"

namespace penumbra::geometry {
namespace {

/// Corners of all triangles of a node's mesh, posed.
std::vector<glm::dvec3> posedCorners(const scene::Scene& scene, const scene::Pose& pose, int node) {
    std::vector<glm::dvec3> corners;
    const int mesh = scene.nodes[static_cast<std::size_t>(node)].mesh;
    for (const auto& p : scene.meshes[static_cast<std::size_t>(mesh)].primitives) {
        const auto positions = scene::posedPositions(scene, pose, node, p);
        for (const auto index : p.indices) corners.push_back(positions[index]);
    }
    return corners;
}

bool holds(const scene::Bounds& outer, const scene::Bounds& inner) {
    return glm::all(glm::lessThanEqual(outer.low, inner.low)) &&
           glm::all(glm::greaterThanEqual(outer.high, inner.high));
}

}  // namespace

double windingNumber(const std::vector<glm::dvec3>& corners, const glm::dvec3& point) {
    double turns = 0;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        const glm::dvec3 a = corners[i] - point, b = corners[i + 1] - point,
                         c = corners[i + 2] - point;
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        turns += std::atan2(
            glm::dot(a, glm::cross(b, c)),
            la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return turns / (2 * M_PI);
}

std::vector<bool> findEnclosing(const scene::Scene& scene, const std::vector<bool>& closed) {
    std::vector<bool> enclosing(scene.nodes.size(), false);
    if (std::find(closed.begin(), closed.end(), true) == closed.end()) return enclosing;
    const auto pose = scene::poseAt(scene, scene::chooseAnimations(scene, ""), 0);
    std::vector<scene::Bounds> bounds(scene.nodes.size());
    for (const int node : scene.order) {
        const int mesh = scene.nodes[static_cast<std::size_t>(node)].mesh;
        if (mesh < 0) continue;
        for (const auto& p : scene.meshes[static_cast<std::size_t>(mesh)].primitives)
            for (const auto& position : scene::posedPositions(scene, pose, node, p))
                bounds[static_cast<std::size_t>(node)].add(position);
    }
    for (const int outer : scene.order) {
        const auto o = static_cast<std::size_t>(outer);
        const auto& node = scene.nodes[o];
        if (node.mesh < 0 || !node.castShadow || !closed[static_cast<std::size_t>(node.mesh)])
            continue;
        std::vector<glm::dvec3> corners;
        for (const int inner : scene.order) {
            const auto i = static_cast<std::size_t>(inner);
            if (enclosing[o]) break;
            if (i == o || bounds[i].empty || !scene.nodes[i].receiveShadow ||
                !holds(bounds[o], bounds[i]))
                continue;
            if (corners.empty()) corners = posedCorners(scene, pose, outer);
            // A mirrored node or a mesh turned inside out winds the other way
            enclosing[o] = std::abs(windingNumber(corners, bounds[i].centre())) > 0.5;
        }
    }
    return enclosing;
}

}  // namespace penumbra::geometry
