// SPDX-License-Identifier: MIT
// Fighting in place: a few stances a loop, joined by curves that neither overshoot nor move a
// planted foot.
#pragma once

#include "make_scene_pose.h"

namespace tools {

enum class Fight { sword, spear, hammer };

inline constexpr float kFightSeconds = 2.0F;

Clip makeFight(Fight fight, float shiftSeconds);

// The pose at the start of the loop, to which a shield is fitted.
Pose fightGuard(Fight fight);

}  // namespace tools
