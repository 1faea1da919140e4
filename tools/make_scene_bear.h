// SPDX-License-Identifier: MIT
// A sitting teddy bear.
#pragma once

#include "make_scene_mesh.h"

namespace tools {

inline constexpr float kBearHeight = 5.2F;  // metres

// Closed, facing +Z, sitting on y = 0, of an even number of triangles.
Mesh makeBear(size_t triangleCount);

// Eyes, nose and buttons, for the same place.
Mesh makeBearButtons();

}  // namespace tools
