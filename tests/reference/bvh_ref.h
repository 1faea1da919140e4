// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/bvh.cl: what a tree of kernels/shared/bvh.h must obey, checked in
// double from the description there and not by building a second tree.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "kernels/shared/bvh.h"

namespace penumbra::tests {

/// Triangles as the device holds them; positions may be NaN or infinite.
struct TreeMesh {
    std::vector<glm::vec3> corners;  ///< [triangle, 3]
    std::vector<bool> casts;         ///< [triangle]
    std::size_t triangles() const { return casts.size(); }
};

struct TreeCopy {
    shared::BvhParams params{};
    std::vector<float> nodes, leaves;
    std::vector<std::uint32_t> leafTriangles;
};

/// What is wrong with the tree, one line each (at most 20); empty: nothing.
///  - levels: each has an eighth of the nodes below, rounded up; the last has one
///  - every caster is in one slot of one leaf, nothing else is in any; leaves hold the corners
///  - boxes of leaves contain their triangles' finite corners and exceed them by the margin alone;
///    boxes above are the union of those below; unused ones are empty
///  - leaves follow the Morton order of centroids, equal cells the order of the mesh, and what is
///    not finite comes last
std::vector<std::string> treeFaults(const TreeCopy& tree, const TreeMesh& mesh);

}  // namespace penumbra::tests
