// SPDX-License-Identifier: MIT
// Stances are places of feet, trunk, hands and weapon; inverse kinematics does the rest.
#include "make_scene_fight.h"

#include <bit>
#include <cmath>

namespace tools {

using glm::quat;
using glm::vec3;

namespace {

// Metres and degrees, in the figure's space. Turns: (yaw to the left, lean forward, roll to the
// left).
struct Stance {
    vec3 hips;  // from its place at rest
    vec3 hipsTurn, chestTurn, headTurn;
    vec3 footL, footR;  // the ankle's place on the floor; y: lift
    vec3 feetYaw;       // left, right; z: heel of the right foot, degrees up
    vec3 grip;          // middle of the right fist
    vec3 weapon;        // direction of the weapon
    vec3 left;          // left wrist, or x: where along the weapon the left fist is
};

constexpr int kStanceFloats = sizeof(Stance) / sizeof(float);
using StanceFloats = std::array<float, kStanceFloats>;

// Guard, wind-up, blow, follow-through; sword in the right hand, shield on the left forearm.
const std::vector<Stance> kSword = {
    {{-0.01F, -0.1F, 0.02F},
     {-32, 4, 0},
     {-8, 8, 0},
     {36, -4, 0},
     {0.13F, 0, 0.3F},
     {-0.15F, 0, -0.27F},
     {8, -48, 12},
     {-0.34F, 1.22F, 0.16F},
     {0.3F, 0.9F, 0.35F},
     {0.12F, 1.2F, 0.37F}},
    {{-0.04F, -0.08F, -0.05F},
     {-44, -4, -2},
     {-20, -2, -6},
     {60, 2, 0},
     {0.13F, 0, 0.3F},
     {-0.15F, 0, -0.27F},
     {8, -48, 0},
     {-0.37F, 1.62F, -0.16F},
     {0.35F, 0.55F, -0.75F},
     {0.16F, 1.3F, 0.36F}},
    {{0.03F, -0.15F, 0.12F},
     {-4, 12, 2},
     {14, 14, 4},
     {-6, -16, 0},
     {0.13F, 0, 0.3F},
     {-0.15F, 0, -0.27F},
     {8, -40, 38},
     {-0.06F, 1.2F, 0.54F},
     {0.25F, -0.05F, 0.95F},
     {0.36F, 1.08F, 0.2F}},
    {{0.02F, -0.14F, 0.09F},
     {6, 12, 2},
     {22, 12, 4},
     {-22, -14, 0},
     {0.13F, 0, 0.3F},
     {-0.15F, 0, -0.27F},
     {8, -40, 34},
     {0.17F, 0.99F, 0.38F},
     {0.8F, -0.35F, 0.4F},
     {0.38F, 1.06F, 0.16F}},
};

// Guard, draw back, thrust with a step, hold; both hands on the shaft.
const std::vector<Stance> kSpear = {
    {{0, -0.11F, 0},
     {-48, 4, 0},
     {-6, 6, 0},
     {50, -4, 0},
     {0.11F, 0, 0.3F},
     {-0.13F, 0, -0.3F},
     {0, -62, 0},
     {-0.27F, 1.1F, -0.02F},
     {0.26F, 0.16F, 0.95F},
     {0.55F, 0, 0}},
    {{-0.02F, -0.13F, -0.08F},
     {-56, 0, 0},
     {-10, 2, 0},
     {62, 0, 0},
     {0.11F, 0, 0.3F},
     {-0.13F, 0, -0.3F},
     {0, -62, 0},
     {-0.29F, 1.14F, -0.2F},
     {0.3F, 0.1F, 0.95F},
     {0.6F, 0, 0}},
    {{0.03F, -0.2F, 0.2F},
     {-34, 14, 0},
     {6, 12, 0},
     {24, -18, 0},
     {0.11F, 0, 0.52F},
     {-0.13F, 0, -0.3F},
     {0, -52, 30},
     {-0.13F, 1.15F, 0.36F},
     {0.16F, 0.06F, 0.98F},
     {0.42F, 0, 0}},
    {{0.02F, -0.16F, 0.12F},
     {-42, 8, 0},
     {0, 8, 0},
     {38, -10, 0},
     {0.11F, 0.06F, 0.43F},
     {-0.13F, 0, -0.3F},
     {0, -58, 14},
     {-0.2F, 1.13F, 0.18F},
     {0.2F, 0.12F, 0.97F},
     {0.48F, 0, 0}},
};

// Guard, raised over the head, blow, recovery; both hands on the shaft.
const std::vector<Stance> kHammer = {
    {{0, -0.12F, 0},
     {-24, 6, 0},
     {-8, 8, 0},
     {28, -6, 0},
     {0.19F, 0, 0.24F},
     {-0.2F, 0, -0.2F},
     {16, -44, 0},
     {-0.2F, 1.2F, 0.34F},
     {-0.3F, 0.86F, 0.2F},
     {-0.36F, 0, 0}},
    {{-0.02F, -0.06F, -0.06F},
     {-30, -8, 0},
     {-12, -10, 0},
     {36, 4, 0},
     {0.19F, 0, 0.24F},
     {-0.2F, 0, -0.2F},
     {16, -44, 0},
     {-0.2F, 1.74F, 0.08F},
     {-0.22F, 0.42F, -0.86F},
     {-0.34F, 0, 0}},
    {{0.02F, -0.24F, 0.12F},
     {4, 22, 0},
     {6, 20, 0},
     {-8, -24, 0},
     {0.19F, 0, 0.24F},
     {-0.2F, 0, -0.2F},
     {16, -36, 30},
     {-0.02F, 1.0F, 0.62F},
     {0.08F, -0.38F, 0.9F},
     {-0.3F, 0, 0}},
    {{0.01F, -0.2F, 0.08F},
     {-4, 16, 0},
     {0, 16, 0},
     {4, -18, 0},
     {0.19F, 0, 0.24F},
     {-0.2F, 0, -0.2F},
     {16, -40, 20},
     {-0.1F, 1.02F, 0.52F},
     {-0.1F, 0.12F, 0.95F},
     {-0.34F, 0, 0}},
};

const std::vector<Stance>& stancesOf(Fight fight) {
    return fight == Fight::sword ? kSword : fight == Fight::spear ? kSpear : kHammer;
}

// A slope that keeps the curve between its keys (Fritsch and Carlson 1980).
float slopeAt(float before, float here, float after) {
    const float in = here - before, out = after - here;
    return in * out <= 0 ? 0 : 2 * in * out / (in + out);
}

// Share of the way to the next stance as time passes: blows are quick, guards are held.
float ease(float t) {
    return t * t * (3 - 2 * t);
}

Stance stanceAt(const std::vector<Stance>& stances, float phase) {
    const auto count = stances.size();
    const float at = (phase - std::floor(phase)) * static_cast<float>(count);
    const size_t key = std::min(static_cast<size_t>(at), count - 1);
    const float t =
        0.5F * (at - static_cast<float>(key)) + 0.5F * ease(at - static_cast<float>(key));
    std::array<StanceFloats, 4> keys;
    for (size_t k = 0; k < 4; ++k)
        keys[k] = std::bit_cast<StanceFloats>(stances[(key + count + k - 1) % count]);
    StanceFloats mixed{};
    for (size_t i = 0; i < mixed.size(); ++i) {
        const float a = keys[1][i], b = keys[2][i];
        const float from = slopeAt(keys[0][i], a, b), to = slopeAt(a, b, keys[3][i]);
        const float t2 = t * t, t3 = t2 * t;
        mixed[i] = a * (2 * t3 - 3 * t2 + 1) + from * (t3 - 2 * t2 + t) + b * (3 * t2 - 2 * t3) +
                   to * (t3 - t2);
    }
    return std::bit_cast<Stance>(mixed);
}

quat turnOf(const vec3& degrees) {
    return turn(degrees.x, vec3(0, 1, 0)) * turn(degrees.y, vec3(1, 0, 0)) *
           turn(degrees.z, vec3(0, 0, 1));
}

void poseTrunk(Pose& pose, const Stance& stance) {
    pose.hips = restOf(kHips) + stance.hips;
    pose.rotations[kHips] = turnOf(stance.hipsTurn);
    const quat chest = pose.rotations[kHips] * turnOf(stance.chestTurn);
    pose.rotations[kSpine] = glm::slerp(pose.rotations[kHips], chest, 0.5F);
    pose.rotations[kChest] = chest;
    pose.rotations[kHead] = chest * turnOf(stance.headTurn);
    pose.rotations[kNeck] = glm::slerp(chest, pose.rotations[kHead], 0.5F);
}

// A flat foot, or one that stands on its ball with the heel up.
void poseLeg(Pose& pose, Side side, const vec3& place, float yawDeg, float heelDeg) {
    const quat outward = turn(yawDeg, vec3(0, 1, 0));
    const Joint foot = onSide(kFootL, side), toes = onSide(kToesL, side);
    pose.rotations[toes] = outward;
    pose.rotations[foot] = outward * pitchUp(-heelDeg);
    vec3 fromBall = restOf(foot) - restOf(toes);
    fromBall.x = 0;
    const vec3 ankle = vec3(place.x, restOf(foot).y + place.y, place.z) +
                       outward * (pitchUp(-heelDeg) * fromBall - fromBall);
    const Joint thigh = onSide(kThighL, side), shin = onSide(kShinL, side);
    const vec3 forward = outward * vec3(0, 0, 1);
    const LimbPose leg =
        poseLimb(thigh, shin, foot, pose.positionOf(thigh), ankle, forward, vec3(0, 0, 1));
    pose.rotations[thigh] = leg.upper;
    pose.rotations[shin] = leg.lower;
}

void poseShieldArm(Pose& pose, const vec3& wrist) {
    const LimbPose arm = poseLimb(kUpperArmL, kLowerArmL, kHandL, pose.positionOf(kUpperArmL),
                                  wrist, vec3(0.5F, -0.8F, -0.1F), vec3(0, 0, -1));
    pose.rotations[kUpperArmL] = arm.upper;
    pose.rotations[kLowerArmL] = arm.lower;
    pose.rotations[kHandL] = arm.lower;
}

Pose poseAt(Fight fight, float phase) {
    const Stance stance = stanceAt(stancesOf(fight), phase);
    Pose pose;
    pose.rotations.fill(quat(1, 0, 0, 0));
    poseTrunk(pose, stance);
    poseLeg(pose, Side::left, stance.footL, stance.feetYaw.x, 0);
    poseLeg(pose, Side::right, stance.footR, stance.feetYaw.y, stance.feetYaw.z);
    const vec3 weapon = glm::normalize(stance.weapon);
    gripBar(pose, Side::right, stance.grip, weapon, vec3(-0.6F, -0.7F, -0.4F));
    if (fight == Fight::sword)
        poseShieldArm(pose, stance.left);
    else
        gripBar(pose, Side::left, stance.grip + stance.left.x * weapon, weapon,
                vec3(0.6F, -0.8F, -0.2F));
    return pose;
}

}  // namespace

Clip makeFight(Fight fight, float shiftSeconds) {
    return makeClip(kFightSeconds, shiftSeconds,
                    [=](float seconds) { return poseAt(fight, seconds / kFightSeconds); });
}

Pose fightGuard(Fight fight) {
    return poseAt(fight, 0);
}

}  // namespace tools
