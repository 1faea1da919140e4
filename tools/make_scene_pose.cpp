// SPDX-License-Identifier: MIT
#include "make_scene_pose.h"

#include <algorithm>
#include <cmath>

namespace tools {

using glm::mat3;
using glm::quat;
using glm::vec3;

namespace {

constexpr int kKeysPerSecond = 24;

// A frame whose first axis runs along a bone and whose second is its hinge, made exactly
// perpendicular.
mat3 boneFrame(const vec3& along, const vec3& hinge) {
    const vec3 straight = glm::normalize(hinge - along * glm::dot(hinge, along));
    return mat3(along, straight, glm::cross(along, straight));
}

struct LimbPlane {
    vec3 middle;  // the elbow or knee
    vec3 hinge;
};

// Places the middle joint; it bends towards the pole. A target out of reach is approached.
LimbPlane bendLimb(const vec3& root, const vec3& target, float upperLength, float lowerLength,
                   const vec3& pole) {
    const vec3 along = glm::normalize(target - root);
    const float reach =
        std::min(glm::distance(root, target), 0.9995F * (upperLength + lowerLength));
    const vec3 side = glm::normalize(pole - along * glm::dot(pole, along));
    const float forward =
        (reach * reach + upperLength * upperLength - lowerLength * lowerLength) / (2 * reach);
    const float aside = std::sqrt(std::max(upperLength * upperLength - forward * forward, 0.0F));
    return {root + along * forward + side * aside, glm::cross(along, side)};
}

}  // namespace

quat turn(float degrees, const vec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
}
quat pitchUp(float degrees) {
    return turn(-degrees, vec3(1, 0, 0));
}

vec3 restOf(Joint joint) {
    return skeleton()[joint].restPosition;
}

Joint onSide(Joint left, Side side) {
    if (side == Side::left) return left;
    return static_cast<Joint>(left +
                              (left >= kThighL ? kThighR - kThighL : kUpperArmR - kUpperArmL));
}

vec3 armDirection(Side side) {
    const vec3 left = armDirectionL();
    return side == Side::left ? left : vec3(-left.x, left.y, left.z);
}

vec3 Pose::positionOf(Joint joint) const {
    const int parent = skeleton()[joint].parent;
    if (parent < 0) return hips;
    const auto above = static_cast<Joint>(parent);
    return positionOf(above) + rotations[above] * (restOf(joint) - restOf(above));
}

LimbPose poseLimb(Joint upper, Joint lower, Joint end, const vec3& root, const vec3& target,
                  const vec3& pole, const vec3& restPole) {
    const float upperLength = glm::distance(restOf(upper), restOf(lower));
    const float lowerLength = glm::distance(restOf(lower), restOf(end));
    const auto rotate = [](const vec3& restAlong, const vec3& restHinge, const vec3& along,
                           const vec3& hinge) {
        return glm::normalize(glm::quat_cast(boneFrame(along, hinge) *
                                             glm::transpose(boneFrame(restAlong, restHinge))));
    };
    const LimbPlane posed = bendLimb(root, target, upperLength, lowerLength, pole);
    const vec3 restUpper = glm::normalize(restOf(lower) - restOf(upper));
    const vec3 restLower = glm::normalize(restOf(end) - restOf(lower));
    const vec3 restAlong = glm::normalize(restOf(end) - restOf(upper));
    const vec3 restSide = glm::normalize(restPole - restAlong * glm::dot(restPole, restAlong));
    const vec3 restHinge = glm::cross(restAlong, restSide);
    const vec3 upperAlong = glm::normalize(posed.middle - root);
    const vec3 lowerAlong = glm::normalize(target - posed.middle);
    return {rotate(restUpper, restHinge, upperAlong, posed.hinge),
            rotate(restLower, restHinge, lowerAlong, posed.hinge), lowerAlong};
}

// The grip fixes the hand; arm and wrist are solved in turns, since each depends on the other.
void gripBar(Pose& pose, Side side, const vec3& grip, const vec3& direction, const vec3& pole) {
    const Joint upper = onSide(kUpperArmL, side), lower = onSide(kLowerArmL, side),
                hand = onSide(kHandL, side);
    const vec3 shoulder = pose.positionOf(upper);
    const mat3 restFrame = boneFrame(armDirection(side), vec3(0, 0, 1));
    vec3 forearm(0, 0, 1);
    for (int iteration = 0; iteration < 12; ++iteration) {
        const vec3 along = glm::normalize(forearm - direction * glm::dot(forearm, direction));
        pose.rotations[hand] =
            glm::normalize(glm::quat_cast(boneFrame(along, direction) * glm::transpose(restFrame)));
        const LimbPose arm = poseLimb(upper, lower, hand, shoulder, grip - kGripDistance * along,
                                      pole, vec3(0, 0, -1));
        pose.rotations[upper] = arm.upper;
        pose.rotations[lower] = arm.lower;
        forearm = arm.lowerDirection;
    }
}

Clip makeClip(float lengthSeconds, float shiftSeconds, const std::function<Pose(float)>& poseAt) {
    Clip clip;
    const int keyCount = static_cast<int>(std::lround(lengthSeconds * kKeysPerSecond)) + 1;
    for (int key = 0; key < keyCount; ++key) {
        const float seconds = static_cast<float>(key) / kKeysPerSecond;
        const Pose pose = poseAt(shiftSeconds + (key + 1 == keyCount ? 0.0F : seconds));
        clip.timesSeconds.push_back(seconds);
        clip.hipsTranslations.push_back(pose.hips);
        for (int joint = 0; joint < kJointCount; ++joint) {
            const int parent = skeleton()[joint].parent;
            quat local = pose.rotations[joint];
            if (parent >= 0) local = glm::normalize(glm::inverse(pose.rotations[parent]) * local);
            auto& keys = clip.rotations[joint];
            if (!keys.empty() && glm::dot(keys.back(), local) < 0) local = -local;
            keys.push_back(local);
        }
    }
    return clip;
}

Clip repeat(const Clip& clip, int loops) {
    Clip longer = clip;
    const auto extend = [](auto& keys, const auto& more) {
        keys.insert(keys.end(), more.begin() + 1, more.end());
    };
    for (int loop = 1; loop < loops; ++loop) {
        const float start = longer.timesSeconds.back();
        for (size_t key = 1; key < clip.timesSeconds.size(); ++key)
            longer.timesSeconds.push_back(start + clip.timesSeconds[key]);
        extend(longer.hipsTranslations, clip.hipsTranslations);
        for (int joint = 0; joint < kJointCount; ++joint)
            extend(longer.rotations[joint], clip.rotations[joint]);
    }
    return longer;
}

}  // namespace tools
