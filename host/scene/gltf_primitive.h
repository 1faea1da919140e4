// SPDX-License-Identifier: MIT
// Work on the triangles of one primitive that does not depend on glTF's encoding.
#pragma once
#include <cstdint>
#include <vector>

#include "host/scene/scene.h"

namespace penumbra::scene {

enum class Topology { triangles, strip, fan };

/// Three corners per triangle from a list, strip or fan of vertices; all windings as in the list.
/// Vertices left over at the end are dropped.
std::vector<std::uint32_t> triangulate(std::vector<std::uint32_t> corners, Topology topology);

/// Bytes of all attributes of one vertex, morph targets included.
std::uint64_t vertexBytes(const Primitive& primitive);

/// Gives each triangle vertices of its own, with its plane's normal (counter-clockwise is front; +Y
/// where the triangle has no area). A target's normals become what reaches its own flat normal at
/// weight 1.
void makeFlatNormals(Primitive& primitive);

/// False if no triangle has an area, at rest and for good: neither morphed nor skinned.
bool hasArea(const Primitive& primitive);

/// Weights of each vertex: not finite or negative ones become 0, then the sum 1; all zero binds to
/// joint 0. Joints without weight become joint 0. Returns the number of vertices that had to be
/// bound.
std::size_t normalizeWeights(Primitive& primitive);

}  // namespace penumbra::scene
