// SPDX-License-Identifier: MIT
// Weapons, shield and pole. Bars stand on the origin along +Y; `detail` scales the number of sides.
#pragma once

#include "make_scene_mesh.h"

namespace tools {

inline constexpr float kSwordGripHeight = 0.1F;
inline constexpr float kSpearLength = 2.1F;
inline constexpr float kHammerLength = 1.15F;
inline constexpr float kPoleLength = 2.6F;

// A weapon's parts by material.
struct Arms {
    Mesh steel, wood;
};

Arms makeSword(float detail);
Arms makeSpear(float detail);
Arms makeHammer(float detail);
Arms makePole(float detail);  // a crossbar at the top holds the flag

// Round, facing +Y, its middle at the origin, grip side below.
Arms makeShield(float detail);

// On the left hip, in the hips joint's space.
Arms makeScabbard(float detail);

}  // namespace tools
