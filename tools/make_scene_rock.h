// SPDX-License-Identifier: MIT
// A cliff of layered rock with a level top where figures stand.
#pragma once

#include "make_scene_mesh.h"

namespace tools {

inline constexpr float kCliffHeight = 2.2F;  // metres, its top

// Closed; stands on y = 0 and reaches a little below it.
Mesh makeCliff(size_t triangleCount);

}  // namespace tools
