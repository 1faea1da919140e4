// SPDX-License-Identifier: MIT
#include "make_scene_cloth.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace tools {

using glm::quat;
using glm::vec3;

namespace {

constexpr int kLinks = 5;

using Surface = std::function<vec3(float u, float v)>;  // 0 .. 1 each, v along the chain

// A grid of quads whose last triangle is a corner at the chain's far end.
void addSheet(Cloth& cloth, uint32_t columns, uint32_t rows, const Surface& surface) {
    constexpr float kStep = 1e-3F;
    for (uint32_t row = 0; row <= rows; ++row) {
        for (uint32_t column = 0; column <= columns; ++column) {
            const float u = static_cast<float>(column) / static_cast<float>(columns);
            const float v = static_cast<float>(row) / static_cast<float>(rows);
            cloth.mesh.positions.push_back(surface(u, v));
            cloth.mesh.normals.push_back(
                glm::normalize(glm::cross(surface(u + kStep, v) - surface(u - kStep, v),
                                          surface(u, v + kStep) - surface(u, v - kStep))));
            const float along = v * (kLinks - 1);
            const int link = std::min(static_cast<int>(along), kLinks - 2);
            const auto second =
                static_cast<uint16_t>(std::lround((along - static_cast<float>(link)) * 65535));
            const auto first = static_cast<uint8_t>(link);
            cloth.joints.push_back({first, static_cast<uint8_t>(second > 0 ? first + 1 : 0), 0, 0});
            cloth.weights.push_back({static_cast<uint16_t>(65535 - second), second, 0, 0});
        }
    }
    for (uint32_t row = 0; row < rows; ++row) {
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t a = row * (columns + 1) + column;
            const uint32_t b = a + 1, c = a + columns + 2, d = a + columns + 1;
            cloth.mesh.indices.insert(cloth.mesh.indices.end(), {a, b, d, b, c, d});
        }
    }
}

}  // namespace

Cloth makeFlag(uint32_t columns, uint32_t rows, float low, float high, float length) {
    Cloth cloth;
    cloth.hinge = vec3(0, 1, 0);
    cloth.swingDeg = 6;
    for (int link = 0; link < kLinks; ++link)
        cloth.jointPositions.emplace_back(length * static_cast<float>(link) / kLinks, high, 0);
    addSheet(cloth, columns, rows, [=](float u, float v) {
        // Folds that grow and slant towards the free end, which sags and is swallow-tailed
        const float tail = 1 - 0.22F * (1 - std::abs(2 * u - 1)) * v * v;
        const float fold = 0.055F * std::sqrt(std::max(v, 0.0F)) * std::sin(8.5F * v + 2.2F * u) *
                           (0.4F + 0.6F * v);
        return vec3(0.016F + length * v * tail, glm::mix(high, low, u) - 0.1F * v * v, fold);
    });
    return cloth;
}

Cloth makeCape(uint32_t columns, uint32_t rows) {
    constexpr float kLength = 1.02F;
    Cloth cloth;
    cloth.hinge = vec3(1, 0, 0);
    cloth.swingDeg = 5;
    for (int link = 0; link < kLinks; ++link)
        cloth.jointPositions.emplace_back(0, 0.17F - kLength * static_cast<float>(link) / kLinks,
                                          -0.14F);
    addSheet(cloth, columns, rows, [=](float u, float v) {
        const float angle = (u - 0.5F) * (2.5F - 0.5F * v);
        const float fold =
            0.03F * v * std::cos(46 * (u - 0.5F)) + 0.012F * v * std::sin(19 * u + 3 * v);
        const float across = 0.215F + 0.12F * v + fold;
        const float behind = 0.155F + 0.1F * v + fold;
        return vec3(-across * std::sin(angle), 0.185F - kLength * v,
                    0.01F - behind * std::cos(angle) - 0.06F * v);
    });
    return cloth;
}

std::vector<std::vector<quat>> waveCloth(const Cloth& cloth, const std::vector<float>& times,
                                         float loopSeconds, float shiftSeconds) {
    std::vector<std::vector<quat>> turns(cloth.jointPositions.size());
    for (size_t link = 0; link < turns.size(); ++link) {
        const float lag = 0.17F * static_cast<float>(link);
        const float swing = cloth.swingDeg * (1 + 0.45F * static_cast<float>(link));
        for (const float time : times) {
            const float phase = (time + shiftSeconds) / loopSeconds - lag;
            const float wave = std::sin(glm::two_pi<float>() * phase) +
                               0.35F * std::sin(2 * glm::two_pi<float>() * phase + 1);
            turns[link].push_back(glm::angleAxis(glm::radians(swing * wave), cloth.hinge));
        }
    }
    return turns;
}

}  // namespace tools
