// SPDX-License-Identifier: MIT
// The figure's walk: two strides in place in two seconds, feet by inverse kinematics, a staff
// planted with each stride.
#pragma once

#include "make_scene_figure.h"

namespace tools {

struct WalkClip {
    std::vector<float> timesSeconds;          // [keys]
    std::vector<glm::vec3> hipsTranslations;  // [keys]
    std::array<std::vector<glm::quat>, kJointCount>
        rotations;  // [joints][keys], relative to the parent
};

// The staff in the right hand's space at rest: along +Y from the tip at the origin.
inline constexpr float kStaffLength = 2.0F;
inline constexpr float kStaffGripHeight = 1.13F;
glm::quat staffRotation();
glm::vec3 staffTranslation();

WalkClip makeWalk();

}  // namespace tools
