// SPDX-License-Identifier: MIT
// Triangulation, flat normals and skin weights of one primitive; see the header.
#include "host/scene/gltf_primitive.h"

#include <cmath>
#include <utility>

namespace penumbra::scene {

namespace {

/// values[i] becomes values[corners[i]]; empty vectors (absent attributes) stay empty.
template <typename Value>
void unshare(std::vector<Value>& values, const std::vector<std::uint32_t>& corners) {
    if (values.empty()) return;
    std::vector<Value> own;
    own.reserve(corners.size());
    for (const std::uint32_t corner : corners) own.push_back(values[corner]);
    values = std::move(own);
}

/// One normal per vertex of unshared triangles.
std::vector<glm::vec3> flatNormals(const std::vector<glm::vec3>& positions) {
    std::vector<glm::vec3> normals(positions.size(), glm::vec3(0, 1, 0));
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
        const glm::dvec3 a(positions[i]), b(positions[i + 1]), c(positions[i + 2]);
        const glm::dvec3 normal = glm::cross(b - a, c - a);  // double: edges of 1e-20 m still count
        const double length = glm::length(normal);
        if (length > 0 && std::isfinite(length))
            normals[i] = normals[i + 1] = normals[i + 2] = glm::vec3(normal / length);
    }
    return normals;
}

}  // namespace

std::vector<std::uint32_t> triangulate(std::vector<std::uint32_t> corners, Topology topology) {
    if (topology == Topology::triangles) {
        corners.resize(corners.size() - corners.size() % 3);
        return corners;
    }
    std::vector<std::uint32_t> triangles;
    const std::size_t count = corners.size() < 3 ? 0 : corners.size() - 2;
    triangles.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {  // glTF 2.0 section 3.7.2.1
        const bool odd = i % 2 == 1;
        if (topology == Topology::strip)
            triangles.insert(triangles.end(),
                             {corners[i], corners[i + (odd ? 2 : 1)], corners[i + (odd ? 1 : 2)]});
        else
            triangles.insert(triangles.end(), {corners[i + 1], corners[i + 2], corners[0]});
    }
    return triangles;
}

std::uint64_t vertexBytes(const Primitive& primitive) {
    std::uint64_t bytes = 2 * sizeof(glm::vec3);
    bytes += primitive.tangents.empty() ? 0 : sizeof(glm::vec4);
    for (const auto& uvs : primitive.uvs) bytes += uvs.empty() ? 0 : sizeof(glm::vec2);
    bytes += primitive.colors.empty() ? 0 : sizeof(glm::vec4);
    bytes +=
        primitive.joints.empty() ? 0 : sizeof primitive.joints[0] + sizeof primitive.weights[0];
    return bytes + primitive.targets.size() * 3 * sizeof(glm::vec3);
}

void makeFlatNormals(Primitive& primitive) {
    const std::vector<std::uint32_t>& corners = primitive.indices;
    unshare(primitive.positions, corners);
    for (auto& uvs : primitive.uvs) unshare(uvs, corners);
    unshare(primitive.colors, corners);
    unshare(primitive.joints, corners);
    unshare(primitive.weights, corners);
    // glTF 2.0 section 3.7.2.1: tangents without normals are ignored
    primitive.tangents.clear();
    primitive.normals = flatNormals(primitive.positions);
    for (MorphTarget& target : primitive.targets) {
        unshare(target.positions, corners);
        target.normals.clear();
        target.tangents.clear();
        if (target.positions.empty()) continue;
        std::vector<glm::vec3> moved = primitive.positions;
        for (std::size_t i = 0; i < moved.size(); ++i) moved[i] += target.positions[i];
        target.normals = flatNormals(moved);
        for (std::size_t i = 0; i < moved.size(); ++i) target.normals[i] -= primitive.normals[i];
    }
    for (std::size_t i = 0; i < primitive.indices.size(); ++i)
        primitive.indices[i] = static_cast<std::uint32_t>(i);
}

bool hasArea(const Primitive& primitive) {
    if (!primitive.targets.empty() || !primitive.joints.empty()) return true;
    const auto& corners = primitive.indices;
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
        const glm::dvec3 a(primitive.positions[corners[i]]);
        const glm::dvec3 b(primitive.positions[corners[i + 1]]);
        const glm::dvec3 c(primitive.positions[corners[i + 2]]);
        if (glm::cross(b - a, c - a) != glm::dvec3(0)) return true;
    }
    return false;
}

std::size_t normalizeWeights(Primitive& primitive) {
    std::size_t bound = 0;
    for (std::size_t vertex = 0; vertex < primitive.weights.size(); ++vertex) {
        std::array<float, 8>& weights = primitive.weights[vertex];
        std::array<std::uint16_t, 8>& joints = primitive.joints[vertex];
        double sum = 0;
        for (float& weight : weights) {
            if (!std::isfinite(weight) || weight < 0) weight = 0;
            sum += static_cast<double>(weight);
        }
        if (sum == 0) {
            weights = {1};
            joints = {0};
            ++bound;
            continue;
        }
        for (std::size_t i = 0; i < weights.size(); ++i) {
            weights[i] = static_cast<float>(static_cast<double>(weights[i]) / sum);
            // Exporters leave anything in unused slots; 0 is always a joint
            if (weights[i] == 0) joints[i] = 0;
        }
    }
    return bound;
}

}  // namespace penumbra::scene
