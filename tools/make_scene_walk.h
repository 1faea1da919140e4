// SPDX-License-Identifier: MIT
// The figure's walk: two strides in place in two seconds, feet by inverse kinematics, a staff
// planted with each stride.
#pragma once

#include "make_scene_pose.h"

namespace tools {

inline constexpr float kWalkSeconds = 2.0F;
inline constexpr float kStaffLength = 2.0F;
inline constexpr float kStaffGripHeight = 1.13F;

// A bar in the right hand's space at rest: along +Y from its end at the origin, held at
// `gripHeight`.
glm::quat barRotation();
glm::vec3 barTranslation(float gripHeight);

// Starts `shiftSeconds` into the walk; without a staff both arms swing.
Clip makeWalk(float shiftSeconds = 0, bool hasStaff = true);

}  // namespace tools
