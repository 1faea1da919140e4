// SPDX-License-Identifier: MIT
// Everything around the figure: hat, staff, potted plant, trellis, crate. Each stands at its own
// origin, base at y = 0.
#pragma once

#include "make_scene_mesh.h"

namespace tools {

Mesh makeHat();  // origin: the head joint
Mesh makeStaff();
Mesh makeStaffRings();
Mesh makePot();
Mesh makeSoil();
Mesh makeLeaves();
Mesh makeTrellis();
Mesh makeCrate();

}  // namespace tools
