// SPDX-License-Identifier: MIT
// Brings a mesh to a wanted number of triangles.
#pragma once

#include "make_scene_mesh.h"

namespace tools {

// Collapses edges in the order of their quadric error (Garland and Heckbert 1997) until at most
// `triangleCount` triangles are left. A closed mesh stays closed and manifold, so that an even
// count is met exactly. `labels` has one entry per triangle (or none); the lines between labels
// keep their place. Normals are dropped. Throws std::runtime_error where no edge is left that can
// go.
void simplify(Mesh& mesh, std::vector<uint8_t>& labels, size_t triangleCount);

}  // namespace tools
