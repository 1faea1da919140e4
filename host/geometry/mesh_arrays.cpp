// SPDX-License-Identifier: MIT
#include "host/geometry/mesh_arrays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "host/geometry/enclosure.h"

namespace penumbra::geometry {
namespace {

using scene::Primitive;

struct PositionHash {
    std::size_t operator()(const std::array<std::uint32_t, 3>& key) const {
        std::uint64_t h = key[0];
        for (const auto word : {key[1], key[2]}) h = (h ^ (h >> 29)) * 0x9e3779b97f4a7c15ULL + word;
        return static_cast<std::size_t>(h ^ (h >> 32));
    }
};

/// Where a primitive's vertices lie in the source arrays.
struct Source {
    int vertex = 0, skinVertex = -1, morphVertex = -1;
};

std::uint32_t packColour(const glm::vec4& c) {
    std::uint32_t packed = 0;
    for (int i = 0; i < 4; ++i) {
        const float clamped = std::clamp(std::isfinite(c[i]) ? c[i] : 0.0F, 0.0F, 1.0F);
        packed |= static_cast<std::uint32_t>(std::lround(clamped * 255)) << (8 * i);
    }
    return packed;
}

template <typename Vector>
void append(std::vector<float>& out, const Vector& v, int count) {
    for (int i = 0; i < count; ++i) out.push_back(v[i]);
}

void appendMorphs(const Primitive& p, std::vector<float>& morphs) {
    const glm::vec3 none(0);
    for (const auto& target : p.targets)
        for (std::size_t i = 0; i < p.positions.size(); ++i) {
            append(morphs, target.positions.empty() ? none : target.positions[i], 3);
            append(morphs, target.normals.empty() ? none : target.normals[i], 3);
            append(morphs, target.tangents.empty() ? none : target.tangents[i], 3);
        }
}

Source appendSource(const Primitive& p, MeshArrays& arrays) {
    Source source;
    source.vertex = static_cast<int>(arrays.positions.size() / 3);
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        append(arrays.positions, p.positions[i], 3);
        append(arrays.normals, p.normals[i], 3);
        append(arrays.tangents, p.tangents.empty() ? glm::vec4(0) : p.tangents[i], 4);
        for (const auto& uvs : p.uvs) append(arrays.uvs, uvs.empty() ? glm::vec2(0) : uvs[i], 2);
        arrays.colours.push_back(p.colors.empty() ? ~0U : packColour(p.colors[i]));
    }
    if (!p.joints.empty()) {
        source.skinVertex = static_cast<int>(arrays.joints.size() / 8);
        for (std::size_t i = 0; i < p.positions.size(); ++i) {
            arrays.joints.insert(arrays.joints.end(), p.joints[i].begin(), p.joints[i].end());
            arrays.weights.insert(arrays.weights.end(), p.weights[i].begin(), p.weights[i].end());
        }
    }
    if (!p.targets.empty()) {
        source.morphVertex = static_cast<int>(arrays.morphs.size() / 9);
        appendMorphs(p, arrays.morphs);
    }
    return source;
}

std::uint32_t drawFlags(const scene::Scene& scene, const scene::Node& node, const Primitive& p,
                        bool closed, bool encloses) {
    const auto& material = scene.materials[static_cast<std::size_t>(p.material)];
    std::uint32_t flags = DRAW_ANY;
    if (node.castShadow) flags |= DRAW_CASTS;
    if (node.receiveShadow) flags |= DRAW_RECEIVES;
    if (!material.doubleSided) flags |= DRAW_SINGLE_SIDED;
    if (closed) flags |= DRAW_CLOSED;
    if (encloses) flags |= DRAW_ENCLOSES;
    if (material.alphaMode == scene::AlphaMode::mask) flags |= DRAW_MASK;
    if (material.alphaMode == scene::AlphaMode::blend || material.transmission > 0)
        flags |= DRAW_BLEND;
    if (material.unlit) flags |= DRAW_UNLIT;
    if (!p.colors.empty()) flags |= DRAW_COLOURS;
    for (const auto* texture : {&material.baseColorTexture, &material.metallicRoughnessTexture,
                                &material.normalTexture, &material.emissiveTexture})
        if (texture->image >= 0) flags |= DRAW_TEXTURED;
    return flags;
}

void appendDraw(const scene::Scene& scene, int nodeIndex, const Primitive& p, const Source& source,
                bool closed, bool encloses, const std::vector<int>& skinFirstMatrix,
                const std::vector<int>& nodeFirstWeight, MeshArrays& arrays) {
    const auto& node = scene.nodes[static_cast<std::size_t>(nodeIndex)];
    const bool skinned = node.skin >= 0 && source.skinVertex >= 0;
    shared::PoseItem item{};
    item.sourceVertex = source.vertex;
    item.targetVertex = static_cast<int>(arrays.vertexItem.size());
    item.vertexCount = static_cast<int>(p.positions.size());
    item.matrix = skinned ? skinFirstMatrix[static_cast<std::size_t>(node.skin)] : nodeIndex;
    item.skinVertex = skinned ? source.skinVertex : -1;
    item.morphVertex = source.morphVertex;
    item.morphCount = static_cast<int>(p.targets.size());
    item.morphWeight = nodeFirstWeight[static_cast<std::size_t>(nodeIndex)];
    const auto drawIndex = static_cast<std::uint32_t>(arrays.draws.size());
    shared::Draw draw{};
    draw.flags = drawFlags(scene, node, p, closed, encloses);
    draw.material = static_cast<std::uint32_t>(p.material);
    draw.object = static_cast<std::uint32_t>(nodeIndex) + 1;
    draw.sourceOffset = source.vertex - item.targetVertex;
    arrays.hasMask |= (draw.flags & DRAW_MASK) != 0;
    arrays.hasBlend |= (draw.flags & DRAW_BLEND) != 0;
    for (const auto index : p.indices)
        arrays.indices.push_back(index + static_cast<std::uint32_t>(item.targetVertex));
    arrays.triangleDraw.insert(arrays.triangleDraw.end(), p.indices.size() / 3, drawIndex);
    arrays.vertexItem.insert(arrays.vertexItem.end(), p.positions.size(),
                             static_cast<std::uint32_t>(arrays.items.size()));
    arrays.items.push_back(item);
    arrays.draws.push_back(draw);
    arrays.drawNode.push_back(nodeIndex);
}

}  // namespace

bool isEdgeClosed(const scene::Mesh& mesh) {
    std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, PositionHash> ids;
    std::vector<std::uint64_t> edges;
    for (const auto& p : mesh.primitives) {
        std::vector<std::uint32_t> joined(p.positions.size());
        for (std::size_t i = 0; i < joined.size(); ++i) {
            const glm::vec3 position = p.positions[i] + 0.0F;  // -0 becomes 0
            std::array<std::uint32_t, 3> key{};
            std::memcpy(key.data(), &position, sizeof key);
            joined[i] = ids.try_emplace(key, static_cast<std::uint32_t>(ids.size())).first->second;
        }
        for (std::size_t t = 0; t + 2 < p.indices.size(); t += 3) {
            const std::uint64_t v[3] = {joined[p.indices[t]], joined[p.indices[t + 1]],
                                        joined[p.indices[t + 2]]};
            if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
            for (int i = 0; i < 3; ++i) edges.push_back(v[i] << 32 | v[(i + 1) % 3]);
        }
    }
    if (edges.empty()) return false;
    auto reversed = edges;
    for (auto& edge : reversed) edge = edge << 32 | edge >> 32;
    std::sort(edges.begin(), edges.end());
    std::sort(reversed.begin(), reversed.end());
    return edges == reversed && std::adjacent_find(edges.begin(), edges.end()) == edges.end();
}

MeshArrays flatten(const scene::Scene& scene, const std::vector<int>& skinFirstMatrix,
                   const std::vector<int>& nodeFirstWeight) {
    MeshArrays arrays;
    std::vector<std::vector<Source>> sources(scene.meshes.size());
    std::vector<bool> closed(scene.meshes.size());
    for (const int nodeIndex : scene.order) {
        const auto meshIndex = scene.nodes[static_cast<std::size_t>(nodeIndex)].mesh;
        if (meshIndex < 0) continue;
        const auto& mesh = scene.meshes[static_cast<std::size_t>(meshIndex)];
        auto& meshSources = sources[static_cast<std::size_t>(meshIndex)];
        if (!meshSources.empty()) continue;
        for (const auto& p : mesh.primitives) meshSources.push_back(appendSource(p, arrays));
        closed[static_cast<std::size_t>(meshIndex)] = isEdgeClosed(mesh);
    }
    const auto enclosing = findEnclosing(scene, closed);
    for (const int nodeIndex : scene.order) {
        const auto node = static_cast<std::size_t>(nodeIndex);
        if (scene.nodes[node].mesh < 0) continue;
        const auto meshIndex = static_cast<std::size_t>(scene.nodes[node].mesh);
        const auto& primitives = scene.meshes[meshIndex].primitives;
        for (std::size_t i = 0; i < primitives.size(); ++i)
            appendDraw(scene, nodeIndex, primitives[i], sources[meshIndex][i], closed[meshIndex],
                       enclosing[node], skinFirstMatrix, nodeFirstWeight, arrays);
    }
    return arrays;
}

}  // namespace penumbra::geometry
