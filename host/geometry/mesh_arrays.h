// SPDX-License-Identifier: MIT
// Flattens a scene's primitives into the arrays that the device reads.
#pragma once
#include <cstdint>
#include <vector>

#include "host/scene/scene.h"
#include "kernels/shared/mesh.h"

namespace penumbra::geometry {

struct MeshArrays {
    // [source vertex]: every primitive once
    std::vector<float> positions, normals, tangents, uvs;
    std::vector<std::uint32_t> colours;
    std::vector<std::uint16_t> joints;  ///< [skinned vertex, 8]
    std::vector<float> weights;         ///< [skinned vertex, 8]
    std::vector<float> morphs;          ///< [displacement, 9]
    // [posed vertex], [triangle]: every use of a primitive by a node
    std::vector<std::uint32_t> vertexItem, indices, triangleDraw;
    std::vector<shared::PoseItem> items;
    std::vector<shared::Draw> draws;
    std::vector<int> drawNode;
    bool hasMask = false, hasBlend = false;
};

/// `skinFirstMatrix` [skin] and `nodeFirstWeight` [node] say where a frame's matrices and weights
/// lie.
MeshArrays flatten(const scene::Scene& scene, const std::vector<int>& skinFirstMatrix,
                   const std::vector<int>& nodeFirstWeight);

/// True if every edge of the mesh, with vertices joined by position, is shared by exactly two
/// triangles that run along it in opposite directions. Triangles with two corners at one place are
/// left out.
bool isEdgeClosed(const scene::Mesh& mesh);

}  // namespace penumbra::geometry
