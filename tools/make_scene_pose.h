// SPDX-License-Identifier: MIT
// Poses of the figure: joint rotations, two-bone inverse kinematics, hands around a bar, and clips
// that sample poses. Space: the figure's, facing +Z, left at +X, floor at y = 0.
#pragma once

#include <functional>

#include "make_scene_figure.h"

namespace tools {

enum class Side { left, right };

struct Pose {
    glm::vec3 hips;
    std::array<glm::quat, kJointCount> rotations;  // in the figure's space

    // Where a joint stands, from its ancestors' rotations.
    glm::vec3 positionOf(Joint joint) const;
};

struct LimbPose {
    glm::quat upper, lower;  // in the figure's space
    glm::vec3 lowerDirection;
};

// A loop, sampled at 24 keys per second.
struct Clip {
    std::vector<float> timesSeconds;          // [keys]
    std::vector<glm::vec3> hipsTranslations;  // [keys]
    std::array<std::vector<glm::quat>, kJointCount>
        rotations;  // [joints][keys], relative to the parent
};

glm::quat turn(float degrees, const glm::vec3& axis);
glm::quat pitchUp(float degrees);
glm::vec3 restOf(Joint joint);

// The joint of the same name on the given side.
Joint onSide(Joint left, Side side);

// The arm's direction at rest, from shoulder to wrist.
glm::vec3 armDirection(Side side);

// Bends a limb so that its end reaches the target, the middle joint towards the pole.
LimbPose poseLimb(Joint upper, Joint lower, Joint end, const glm::vec3& root,
                  const glm::vec3& target, const glm::vec3& pole, const glm::vec3& restPole);

// Poses an arm so that its fist closes around a bar at `grip` that points along `direction`.
void gripBar(Pose& pose, Side side, const glm::vec3& grip, const glm::vec3& direction,
             const glm::vec3& pole);

// Samples `poseAt` from `shiftSeconds` on; its last key repeats the first, so that the loop is
// exact.
Clip makeClip(float lengthSeconds, float shiftSeconds, const std::function<Pose(float)>& poseAt);

// The clip, `loops` times over.
Clip repeat(const Clip& clip, int loops);

}  // namespace tools
