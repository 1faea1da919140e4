// SPDX-License-Identifier: MIT
// Walk cycle: pelvis path and foot paths as functions of the stride's phase, inverse kinematics for
// legs and the staff arm, forward kinematics for the rest.
#include "make_scene_walk.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace tools {

using glm::quat;
using glm::vec3;

namespace {

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
    const auto on = [&](Joint left) { return onSide(left, side > 0 ? Side::left : Side::right); };
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

void poseFreeArm(Pose& pose, Side side, float phase) {
    const float out = side == Side::left ? 1.0F : -1.0F;
    const Joint upper = onSide(kUpperArmL, side), lower = onSide(kLowerArmL, side);
    const vec3 x(1, 0, 0);
    const vec3 hinge(std::cos(glm::radians(40.0F)), out * std::sin(glm::radians(40.0F)), 0);
    const float swing = cosineOf(phase - 0.03F);
    const quat lowered = turn(out * -29, vec3(0, 0, 1));
    pose.rotations[upper] = pose.rotations[kChest] * turn(-6 + 25 * swing, x) * lowered;
    const float flex = 23 - 11 * cosineOf(phase - 0.08F);
    pose.rotations[lower] = pose.rotations[upper] * turn(-flex, hinge);
    pose.rotations[onSide(kHandL, side)] =
        pose.rotations[lower] * turn(-6 + 6 * cosineOf(phase - 0.15F), hinge);
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

void poseStaffArm(Pose& pose, float phase) {
    const StaffState staff = staffAt(phase);
    gripBar(pose, Side::right, staff.tip + kStaffGripHeight * staff.direction, staff.direction,
            vec3(-0.45F, -0.6F, -0.75F));
}

Pose poseAt(float seconds, bool hasStaff) {
    const auto wrap = [](float x) { return x - std::floor(x); };
    const float phase = wrap(seconds / kStrideSeconds);
    Pose pose;
    pose.rotations.fill(quat(1, 0, 0, 0));
    poseTrunk(pose, phase, wrap(seconds / kWalkSeconds));
    poseLeg(pose, phase, 1);
    poseLeg(pose, wrap(phase + 0.5F), -1);
    poseFreeArm(pose, Side::left, phase);
    if (hasStaff)
        poseStaffArm(pose, wrap(phase + 0.03F));
    else
        poseFreeArm(pose, Side::right, wrap(phase + 0.5F));
    return pose;
}

}  // namespace

quat barRotation() {
    return glm::angleAxis(glm::half_pi<float>(), vec3(1, 0, 0));
}

vec3 barTranslation(float gripHeight) {
    return kGripDistance * armDirection(Side::right) - vec3(0, 0, gripHeight);
}

Clip makeWalk(float shiftSeconds, bool hasStaff) {
    return makeClip(kWalkSeconds, shiftSeconds,
                    [=](float seconds) { return poseAt(seconds, hasStaff); });
}

}  // namespace tools
