// SPDX-License-Identifier: MIT
// Walk cycle: pelvis path and foot paths as functions of the stride's phase, two-bone inverse
// kinematics for legs and the staff arm, forward kinematics for the rest. Space: the figure's,
// facing +Z, left at +X, floor at y = 0.
#include "make_scene_walk.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace tools {

using glm::mat3;
using glm::quat;
using glm::vec3;

namespace {

constexpr int kKeysPerSecond = 24;
constexpr float kClipSeconds = 2.0F;
constexpr float kStrideSeconds = 1.0F;
constexpr float kFloorSpeed = 1.1F;    // metres per second, backwards under the figure
constexpr float kStanceShare = 0.62F;  // of the stride
constexpr float kHeelShare = 0.11F;    // until the sole is flat
constexpr float kFlatShare = 0.34F;    // until the heel rises
constexpr float kStrikePitch = 19.0F;  // degrees, toes up
constexpr float kPushPitch = -50.0F;   // degrees, heel up
constexpr float kStrikeAhead =
    0.33F;  // metres from the hips to the flat ankle's place at heel strike
constexpr float kFootSpacing = 0.085F;  // metres from the middle

float cosineOf(float phase) {
    return std::cos(glm::two_pi<float>() * phase);
}

quat turn(float degrees, const vec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
}
quat pitchUp(float degrees) {
    return turn(-degrees, vec3(1, 0, 0));
}

vec3 restOf(Joint joint) {
    return skeleton()[joint].restPosition;
}

struct FootState {
    float height, ahead;           // of the ankle, metres
    float pitchDeg, toesPitchDeg;  // in the figure's space, toes up
};

FootState stanceAt(float phase) {
    const vec3 ankle = restOf(kFootL);
    const float flatAhead = kStrikeAhead - kFloorSpeed * kStrideSeconds * phase;
    vec3 pivot(0);  // relative to the ankle at rest
    float pitch = 0;
    if (phase < kHeelShare) {
        const float left = 1 - phase / kHeelShare;
        pitch = kStrikePitch * left * left;
        pivot = vec3(0, -ankle.y, -0.062F);
    } else if (phase > kFlatShare) {
        const float share = (phase - kFlatShare) / (kStanceShare - kFlatShare);
        pitch = kPushPitch * share * share;
        pivot = restOf(kToesL) - ankle;
        pivot.x = 0;
    }
    const vec3 fromPivot = pitchUp(pitch) * -pivot;
    return {ankle.y + pivot.y + fromPivot.y, flatAhead + pivot.z + fromPivot.z, pitch,
            std::max(pitch, 0.0F)};
}

// Cubic from (a, slopeA) to (b, slopeB) over t in 0 .. 1.
float hermite(float a, float slopeA, float b, float slopeB, float t) {
    const float t2 = t * t;
    const float t3 = t2 * t;
    return a * (2 * t3 - 3 * t2 + 1) + slopeA * (t3 - 2 * t2 + t) + b * (3 * t2 - 2 * t3) +
           slopeB * (t3 - t2);
}

FootState footAt(float phase) {
    if (phase <= kStanceShare) return stanceAt(phase);
    // The swing joins the stance with its speed at both ends.
    constexpr float kStep = 0.01F;
    const float t = (phase - kStanceShare) / (1 - kStanceShare);
    const FootState from = stanceAt(kStanceShare);
    const FootState before = stanceAt(kStanceShare - kStep);
    const FootState to = stanceAt(0);
    const FootState after = stanceAt(kStep);
    const auto blend = [&](float FootState::*field, float ease) {
        const float scale = (1 - kStanceShare) / kStep * ease;
        return hermite(from.*field, (from.*field - before.*field) * scale, to.*field,
                       (after.*field - to.*field) * scale, t);
    };
    FootState state{};
    state.height = blend(&FootState::height, 0.7F) + 0.05F * t * t * (1 - t) * (1 - t) * 16;
    state.ahead = blend(&FootState::ahead, 0.6F);
    state.pitchDeg = blend(&FootState::pitchDeg, 0.35F);
    const float follow = std::min(1.0F, 2.2F * t);
    state.toesPitchDeg = state.pitchDeg * follow * follow * (3 - 2 * follow);
    return state;
}

// A frame whose first axis runs along a bone and whose second is its hinge, made exactly
// perpendicular.
mat3 boneFrame(const vec3& along, const vec3& hinge) {
    const vec3 straight = glm::normalize(hinge - along * glm::dot(hinge, along));
    return mat3(along, straight, glm::cross(along, straight));
}

struct LimbPose {
    quat upper, lower;  // in the figure's space
    vec3 lowerDirection;
};

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

struct Pose {
    vec3 hips;
    std::array<quat, kJointCount> rotations;  // in the figure's space

    // Where a joint stands, from its ancestors' rotations.
    vec3 positionOf(Joint joint) const {
        const int parent = skeleton()[joint].parent;
        if (parent < 0) return hips;
        const auto above = static_cast<Joint>(parent);
        return positionOf(above) + rotations[above] * (restOf(joint) - restOf(above));
    }
};

void poseTrunk(Pose& pose, float phase, float clipPhase) {
    const vec3 x(1, 0, 0);
    const vec3 y(0, 1, 0);
    const vec3 z(0, 0, 1);
    const float midStance = phase - 0.31F;
    pose.hips = restOf(kHips) +
                vec3(0.017F * cosineOf(midStance), -0.032F + 0.017F * cosineOf(2 * midStance), 0);
    const float swing = cosineOf(phase);
    pose.rotations[kHips] =
        turn(-6.5F * swing, y) * turn(2.8F * cosineOf(midStance), z) * turn(2, x);
    pose.rotations[kSpine] =
        turn(-0.5F * swing, y) * turn(-0.5F * cosineOf(midStance), z) * turn(4, x);
    pose.rotations[kChest] =
        turn(6.5F * swing, y) * turn(-1.8F * cosineOf(midStance), z) * turn(4, x);
    // The head looks around once per clip and stays level.
    const float look = 9 * std::sin(glm::two_pi<float>() * clipPhase);
    pose.rotations[kNeck] = turn(2.5F * swing + 0.4F * look, y) * turn(3, x);
    pose.rotations[kHead] = turn(look, y) * turn(1.5F + 1.2F * cosineOf(2 * midStance + 0.1F), x);
}

void poseLeg(Pose& pose, float phase, float side) {
    const bool isLeft = side > 0;
    const auto on = [&](Joint left) {
        return static_cast<Joint>(isLeft ? left : left + kThighR - kThighL);
    };
    const FootState foot = footAt(phase);
    const quat outward = turn(side * 6, vec3(0, 1, 0));
    pose.rotations[on(kFootL)] = outward * pitchUp(foot.pitchDeg);
    pose.rotations[on(kToesL)] = outward * pitchUp(foot.toesPitchDeg);
    const vec3 ankle(side * kFootSpacing, foot.height, foot.ahead);
    const LimbPose leg = poseLimb(on(kThighL), on(kShinL), on(kFootL), pose.positionOf(on(kThighL)),
                                  ankle, vec3(side * 0.08F, 0, 1), vec3(0, 0, 1));
    pose.rotations[on(kThighL)] = leg.upper;
    pose.rotations[on(kShinL)] = leg.lower;
}

void poseFreeArm(Pose& pose, float phase) {
    const vec3 x(1, 0, 0);
    const vec3 hinge(std::cos(glm::radians(40.0F)), std::sin(glm::radians(40.0F)), 0);
    const float swing = cosineOf(phase - 0.03F);
    const quat lowered = turn(-29, vec3(0, 0, 1));
    pose.rotations[kUpperArmL] = pose.rotations[kChest] * turn(-6 + 25 * swing, x) * lowered;
    const float flex = 23 - 11 * cosineOf(phase - 0.08F);
    pose.rotations[kLowerArmL] = pose.rotations[kUpperArmL] * turn(-flex, hinge);
    pose.rotations[kHandL] =
        pose.rotations[kLowerArmL] * turn(-6 + 6 * cosineOf(phase - 0.15F), hinge);
}

struct StaffState {
    vec3 tip, direction;  // direction towards the top
};

// The tip stands on the floor for half of the stride and then swings forward.
StaffState staffAt(float phase) {
    constexpr float kPlanted = 0.56F;     // share of the stride
    constexpr float kStaffAhead = 0.56F;  // metres, when it is set down
    const float travel = kFloorSpeed * kStrideSeconds * kPlanted;
    float lift = 0;
    float ahead = kStaffAhead - kFloorSpeed * kStrideSeconds * phase;
    if (phase > kPlanted) {
        const float t = (phase - kPlanted) / (1 - kPlanted);
        const float slope = -kFloorSpeed * kStrideSeconds * (1 - kPlanted);
        ahead = hermite(kStaffAhead - travel, slope, kStaffAhead, slope, t);
        lift = 0.085F * 16 * t * t * (1 - t) * (1 - t);
    }
    const vec3 tip(-0.4F, 0.004F + lift, ahead);
    const float gripAhead = 0.35F + 0.1F * cosineOf(phase - 0.02F);
    const float aside = 0.03F;
    const float forward = gripAhead - ahead;
    const float up =
        std::sqrt(kStaffGripHeight * kStaffGripHeight - aside * aside - forward * forward) -
        0.45F * lift;
    return {tip, glm::normalize(vec3(aside, up, forward))};
}

vec3 armDirectionR() {
    const vec3 left = armDirectionL();
    return vec3(-left.x, left.y, left.z);
}

// The grip fixes the hand; arm and wrist are solved in turns, since each depends on the other.
void poseStaffArm(Pose& pose, float phase) {
    const StaffState staff = staffAt(phase);
    const vec3 grip = staff.tip + kStaffGripHeight * staff.direction;
    const vec3 shoulder = pose.positionOf(kUpperArmR);
    const mat3 restFrame = boneFrame(armDirectionR(), vec3(0, 0, 1));
    vec3 forearm(0, 0, 1);
    for (int iteration = 0; iteration < 12; ++iteration) {
        const vec3 along =
            glm::normalize(forearm - staff.direction * glm::dot(forearm, staff.direction));
        const quat hand = glm::normalize(
            glm::quat_cast(boneFrame(along, staff.direction) * glm::transpose(restFrame)));
        const LimbPose arm =
            poseLimb(kUpperArmR, kLowerArmR, kHandR, shoulder, grip - kGripDistance * along,
                     vec3(-0.45F, -0.6F, -0.75F), vec3(0, 0, -1));
        pose.rotations[kUpperArmR] = arm.upper;
        pose.rotations[kLowerArmR] = arm.lower;
        pose.rotations[kHandR] = hand;
        forearm = arm.lowerDirection;
    }
}

Pose poseAt(float seconds) {
    const auto wrap = [](float x) { return x - std::floor(x); };
    const float phase = wrap(seconds / kStrideSeconds);
    Pose pose;
    pose.rotations.fill(quat(1, 0, 0, 0));
    poseTrunk(pose, phase, wrap(seconds / kClipSeconds));
    poseLeg(pose, phase, 1);
    poseLeg(pose, wrap(phase + 0.5F), -1);
    poseFreeArm(pose, phase);
    poseStaffArm(pose, wrap(phase + 0.03F));
    return pose;
}

}  // namespace

quat staffRotation() {
    return glm::angleAxis(glm::half_pi<float>(), vec3(1, 0, 0));
}

vec3 staffTranslation() {
    return kGripDistance * armDirectionR() - vec3(0, 0, kStaffGripHeight);
}

WalkClip makeWalk() {
    WalkClip clip;
    const int keyCount = static_cast<int>(kClipSeconds) * kKeysPerSecond + 1;
    for (int key = 0; key < keyCount; ++key) {
        // The last key repeats the first, so that the loop is exact.
        const bool isLast = key + 1 == keyCount;
        const Pose pose = poseAt(isLast ? 0.0F : static_cast<float>(key) / kKeysPerSecond);
        clip.timesSeconds.push_back(static_cast<float>(key) / kKeysPerSecond);
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

}  // namespace tools
