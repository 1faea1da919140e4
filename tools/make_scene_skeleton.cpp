// SPDX-License-Identifier: MIT
// The figure's skeleton and its joint weights.
#include <algorithm>
#include <cmath>

#include "make_scene_figure.h"

namespace tools {

using glm::vec3;

namespace {

constexpr float kArmAngleDeg = 40;  // from vertical
constexpr float kUpperArmLength = 0.285F;
constexpr float kLowerArmLength = 0.25F;

vec3 mirror(const vec3& p) {
    return vec3(-p.x, p.y, p.z);
}

std::array<JointInfo, kJointCount> makeSkeleton() {
    const vec3 shoulder(0.178F, 1.415F, -0.01F);
    const vec3 elbow = shoulder + kUpperArmLength * armDirectionL();
    const vec3 wrist = elbow + kLowerArmLength * armDirectionL();
    const vec3 hip(0.09F, 0.92F, 0);
    const vec3 knee(0.1F, 0.5F, 0.014F);
    const vec3 ankle(0.11F, 0.09F, -0.02F);
    const vec3 ball(0.114F, 0.025F, 0.1F);
    return {{
        {"hips", -1, {0, 0.97F, 0}},
        {"spine", kHips, {0, 1.09F, 0}},
        {"chest", kSpine, {0, 1.24F, 0}},
        {"neck", kChest, {0, 1.465F, -0.015F}},
        {"head", kNeck, {0, 1.555F, 0}},
        {"upperArm.L", kChest, shoulder},
        {"lowerArm.L", kUpperArmL, elbow},
        {"hand.L", kLowerArmL, wrist},
        {"upperArm.R", kChest, mirror(shoulder)},
        {"lowerArm.R", kUpperArmR, mirror(elbow)},
        {"hand.R", kLowerArmR, mirror(wrist)},
        {"thigh.L", kHips, hip},
        {"shin.L", kThighL, knee},
        {"foot.L", kShinL, ankle},
        {"toes.L", kFootL, ball},
        {"thigh.R", kHips, mirror(hip)},
        {"shin.R", kThighR, mirror(knee)},
        {"foot.R", kShinR, mirror(ankle)},
        {"toes.R", kFootR, mirror(ball)},
    }};
}

// A bone as a capsule; a joint may own several.
struct Bone {
    Joint joint;
    vec3 from, to;
    float radius;
};

std::vector<Bone> makeBones() {
    const auto at = [](Joint joint) { return skeleton()[joint].restPosition; };
    std::vector<Bone> bones = {
        {kHips, {0, 0.96F, 0}, {0, 1.03F, 0}, 0.11F},
        {kSpine, {0, 1.09F, 0}, {0, 1.19F, 0}, 0.11F},
        {kChest, {0, 1.27F, 0}, {0, 1.4F, 0}, 0.115F},
        {kNeck, {0, 1.475F, -0.015F}, {0, 1.53F, -0.005F}, 0.055F},
        {kHead, {0, 1.6F, 0.01F}, {0, 1.72F, 0}, 0.08F},
    };
    const std::vector<Bone> left = {
        {kHips, {0.03F, 0.945F, 0}, {0.075F, 0.945F, 0}, 0.09F},
        {kChest, {0.03F, 1.4F, -0.01F}, {0.115F, 1.41F, -0.01F}, 0.06F},
        {kUpperArmL, at(kUpperArmL) + 0.025F * armDirectionL(), at(kLowerArmL), 0.045F},
        {kLowerArmL, at(kLowerArmL), at(kHandL), 0.04F},
        {kHandL, at(kHandL), at(kHandL) + 0.1F * armDirectionL(), 0.03F},
        {kThighL, at(kThighL) - vec3(0, 0.03F, 0), at(kShinL), 0.075F},
        {kShinL, at(kShinL), at(kFootL) + vec3(0, 0.02F, 0), 0.05F},
        {kFootL, at(kFootL) - vec3(0, 0.03F, 0), at(kToesL) - vec3(0, 0, 0.02F), 0.04F},
        {kFootL, at(kFootL) - vec3(0, 0.03F, 0), at(kFootL) + vec3(0, -0.05F, -0.03F), 0.04F},
        {kToesL, at(kToesL) - vec3(0, 0, 0.014F), at(kToesL) + vec3(0.004F, 0, 0.07F), 0.035F},
    };
    for (const Bone& bone : left) {
        bones.push_back(bone);
        int joint = bone.joint;
        if (joint >= kThighL) joint += kThighR - kThighL;
        if (joint >= kUpperArmL && joint <= kHandL) joint += kUpperArmR - kUpperArmL;
        bones.push_back(
            {static_cast<Joint>(joint), mirror(bone.from), mirror(bone.to), bone.radius});
    }
    return bones;
}

float distanceTo(const Bone& bone, const vec3& p) {
    const vec3 axis = bone.to - bone.from;
    const float share =
        std::clamp(glm::dot(p - bone.from, axis) / glm::dot(axis, axis), 0.0F, 1.0F);
    return glm::length(p - bone.from - axis * share) - bone.radius;
}

// Metres of distance over which a farther bone's weight fades; wide in the coat's skirt, which both
// legs move.
float blendWidthAt(const vec3& position) {
    const float aside = std::abs(position.x);
    const float inSkirt = std::clamp((position.y - 0.69F) / 0.05F, 0.0F, 1.0F) *
                          std::clamp((0.99F - position.y) / 0.12F, 0.0F, 1.0F) *
                          std::clamp((0.32F - aside) / 0.05F, 0.0F, 1.0F);
    return 0.045F + 0.13F * inSkirt;
}

}  // namespace

vec3 armDirectionL() {
    const float angle = glm::radians(kArmAngleDeg);
    return vec3(std::sin(angle), -std::cos(angle), 0);
}

const std::array<JointInfo, kJointCount>& skeleton() {
    static const std::array<JointInfo, kJointCount> joints = makeSkeleton();
    return joints;
}

void assignWeights(Figure& figure) {
    const std::vector<Bone> bones = makeBones();
    for (const vec3& position : figure.skin.positions) {
        std::array<float, kJointCount> distances;
        distances.fill(1e9F);
        for (const Bone& bone : bones) {
            distances[bone.joint] = std::min(distances[bone.joint], distanceTo(bone, position));
        }
        const float blendWidth = blendWidthAt(position);
        const float nearest = *std::min_element(distances.begin(), distances.end());
        std::array<std::pair<float, uint8_t>, kJointCount> shares;
        for (uint8_t joint = 0; joint < kJointCount; ++joint) {
            const float fade = std::max(0.0F, 1 - (distances[joint] - nearest) / blendWidth);
            shares[joint] = {-fade * fade,
                             joint};  // negative: sorts the largest first, ties by joint
        }
        std::sort(shares.begin(), shares.end());
        float sum = 0;
        for (int k = 0; k < 4; ++k) sum -= shares[k].first;
        std::array<uint8_t, 4> joints{};
        std::array<uint16_t, 4> weights{};
        int rest = 65535;
        for (int k = 3; k >= 0; --k) {
            const float share = -shares[k].first / sum;
            const int weight = k == 0 ? rest : static_cast<int>(std::lround(share * 65535.0F));
            weights[k] = static_cast<uint16_t>(weight);
            joints[k] = weight > 0 ? shares[k].second : uint8_t{0};
            rest -= weight;
        }
        figure.joints.push_back(joints);
        figure.weights.push_back(weights);
    }
}

}  // namespace tools
