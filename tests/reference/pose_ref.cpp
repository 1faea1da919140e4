// SPDX-License-Identifier: MIT
#include "tests/reference/pose_ref.h"

namespace penumbra::tests {
namespace {

glm::dvec3 displaced(const glm::dvec3& base, const std::vector<scene::MorphTarget>& targets,
                     std::vector<glm::vec3> scene::MorphTarget::*attribute,
                     const std::vector<float>& weights, std::size_t vertex) {
    glm::dvec3 sum = base;
    for (std::size_t t = 0; t < targets.size() && t < weights.size(); ++t) {
        const auto& moves = targets[t].*attribute;
        if (!moves.empty()) sum += static_cast<double>(weights[t]) * glm::dvec3(moves[vertex]);
    }
    return sum;
}

glm::dmat4 skinMatrix(const scene::Scene& scene, const scene::Pose& pose, const scene::Skin& skin,
                      const scene::Primitive& primitive, std::size_t vertex) {
    glm::dmat4 sum(0);
    (void)scene;
    for (std::size_t k = 0; k < 8; ++k) {
        const auto joint = static_cast<std::size_t>(primitive.joints[vertex][k]);
        const double weight = primitive.weights[vertex][k];
        if (weight == 0) continue;
        const glm::dmat4 world = pose.worldFromNode[static_cast<std::size_t>(skin.joints[joint])];
        sum += weight * (world * skin.jointFromMesh[joint]);
    }
    return sum;
}

}  // namespace

PosedVertices poseReference(const scene::Scene& scene, const scene::Pose& pose, int node,
                            const scene::Primitive& primitive) {
    PosedVertices posed;
    const auto index = static_cast<std::size_t>(node);
    const auto& weights = pose.weights[index];
    const int skin = scene.nodes[index].skin;
    for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
        const glm::dvec3 p = displaced(primitive.positions[i], primitive.targets,
                                       &scene::MorphTarget::positions, weights, i);
        const glm::dvec3 n = displaced(primitive.normals[i], primitive.targets,
                                       &scene::MorphTarget::normals, weights, i);
        const bool skinned = skin >= 0 && !primitive.joints.empty();
        const glm::dmat4 m =
            skinned
                ? skinMatrix(scene, pose, scene.skins[static_cast<std::size_t>(skin)], primitive, i)
                : pose.worldFromNode[index];
        posed.positions.emplace_back(m * glm::dvec4(p, 1));
        posed.normals.push_back(glm::normalize(glm::transpose(glm::inverse(glm::dmat3(m))) * n));
    }
    return posed;
}

std::vector<PosedTriangle> posedTriangles(const scene::Scene& scene, const scene::Pose& pose) {
    std::vector<PosedTriangle> triangles;
    for (const int node : scene.order) {
        const int mesh = scene.nodes[static_cast<std::size_t>(node)].mesh;
        if (mesh < 0) continue;
        const auto& primitives = scene.meshes[static_cast<std::size_t>(mesh)].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const auto posed = poseReference(scene, pose, node, primitives[p]);
            const auto& indices = primitives[p].indices;
            for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
                PosedTriangle triangle;
                triangle.node = node;
                triangle.primitive = static_cast<int>(p);
                for (std::size_t c = 0; c < 3; ++c) {
                    triangle.indices[c] = indices[t + c];
                    triangle.corners[c] = posed.positions[indices[t + c]];
                }
                triangles.push_back(triangle);
            }
        }
    }
    return triangles;
}

}  // namespace penumbra::tests
