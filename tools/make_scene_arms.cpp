// SPDX-License-Identifier: MIT
#include "make_scene_arms.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace tools {

using glm::quat;
using glm::vec2;
using glm::vec3;

namespace {

const quat kUnturned(1, 0, 0, 0);

uint32_t sidesOf(float detail, float sides) {
    return std::max(4U, static_cast<uint32_t>(std::lround(sides * detail)));
}

// A round shaft of slightly uneven thickness.
Mesh makeShaft(float low, float high, float radius, float detail) {
    std::vector<SweepRing> rings;
    const uint32_t segments = sidesOf(detail, (high - low) * 30);
    for (uint32_t i = 0; i <= segments; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(segments);
        const float uneven = 1 + 0.05F * std::sin(23 * t) + 0.04F * std::sin(51 * t + 1);
        rings.push_back({vec3(0, glm::mix(low, high, t), 0), radius * uneven, radius * uneven});
    }
    return makeSweep(rings, vec3(0, 0, 1), sidesOf(detail, 16));
}

// A blade of diamond section: half-widths at equal steps from low to high.
Mesh makeBlade(float low, float high, const std::vector<float>& halfWidths, float halfThickness) {
    std::vector<SweepRing> rings;
    for (size_t i = 0; i < halfWidths.size(); ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(halfWidths.size() - 1);
        rings.push_back({vec3(0, glm::mix(low, high, t), 0), halfWidths[i],
                         halfThickness * std::min(1.0F, halfWidths[i] / 0.015F)});
    }
    return makeSweep(rings, vec3(0, 0, 1), 4);
}

std::vector<float> swordOutline(int steps) {
    std::vector<float> widths;
    for (int i = 0; i <= steps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(steps);
        widths.push_back(t < 0.85F ? 0.03F - 0.009F * t
                                   : std::max(0.0008F, 0.0223F * std::sqrt((1 - t) / 0.15F)));
    }
    return widths;
}

// Rings of wire around a grip.
void addBands(Mesh& mesh, float low, float high, int count, float radius, float detail) {
    for (int i = 0; i < count; ++i) {
        const float share = (static_cast<float>(i) + 0.5F) / static_cast<float>(count);
        append(mesh, makeTorus(radius, 0.0035F, sidesOf(detail, 20), sidesOf(detail, 8)), kUnturned,
               vec3(0, glm::mix(low, high, share), 0));
    }
}

}  // namespace

Arms makeSword(float detail) {
    Mesh steel, wood;
    append(steel,
           makeBlade(0.2F, 1.06F, swordOutline(static_cast<int>(sidesOf(detail, 40))), 0.006F));
    std::vector<SweepRing> guard;
    for (int i = -6; i <= 6; ++i) {
        const float t = static_cast<float>(i) / 6;
        const float thick = 0.009F + 0.004F * t * t;
        guard.push_back({vec3(0.115F * t, 0.2F + 0.022F * t * t, 0), thick, thick});
    }
    append(steel, makeSweep(guard, vec3(0, 1, 0), sidesOf(detail, 12)));
    append(steel, makeSphere(0.026F, sidesOf(detail, 20), sidesOf(detail, 12)), kUnturned,
           vec3(0, -0.012F, 0));
    append(wood, makeShaft(0.005F, 0.195F, 0.0145F, detail));
    addBands(steel, 0.01F, 0.19F, 7, 0.0152F, detail);
    return {withNormals(steel, 35), withNormals(wood, 60)};
}

Arms makeSpear(float detail) {
    Mesh steel;
    std::vector<float> widths;
    for (int i = 0; i <= 16; ++i) {
        const float t = static_cast<float>(i) / 16;
        widths.push_back(std::max(0.0008F, 0.016F + 0.09F * std::sqrt(t) * (1 - t) - 0.016F * t));
    }
    append(steel, makeBlade(kSpearLength - 0.34F, kSpearLength, widths, 0.01F));
    append(steel, makeBar({-0.085F, kSpearLength - 0.37F, 0}, {0.085F, kSpearLength - 0.37F, 0},
                          0.007F, sidesOf(detail, 10)));
    append(steel, makeLathe({{0.001F, 0}, {0.014F, 0.06F}, {0.019F, 0.1F}, {0.016F, 0.11F}},
                            sidesOf(detail, 16)));
    addBands(steel, kSpearLength - 0.52F, kSpearLength - 0.38F, 4, 0.0165F, detail);
    return {withNormals(steel, 35),
            withNormals(makeShaft(0.05F, kSpearLength - 0.33F, 0.0155F, detail), 60)};
}

Arms makeHammer(float detail) {
    Mesh steel;
    const float top = kHammerLength - 0.1F;
    // The head: a waisted octagonal block with a flat face at one end and a spike at the other
    const std::vector<SweepRing> head = {
        {{0.165F, top, 0}, 0.068F, 0.068F},        {{0.16F, top, 0}, 0.078F, 0.078F},
        {{0.115F, top, 0}, 0.08F, 0.08F},          {{0.105F, top, 0}, 0.062F, 0.062F},
        {{0.04F, top, 0}, 0.055F, 0.055F},         {{0.035F, top, 0}, 0.066F, 0.066F},
        {{-0.035F, top, 0}, 0.066F, 0.066F},       {{-0.04F, top, 0}, 0.05F, 0.05F},
        {{-0.1F, top, 0}, 0.038F, 0.04F},          {{-0.17F, top - 0.012F, 0}, 0.022F, 0.026F},
        {{-0.24F, top - 0.04F, 0}, 0.002F, 0.002F}};
    append(steel, makeSweep(head, vec3(0, 1, 0), 8));
    append(steel, makeLathe({{0.03F, top + 0.05F}, {0.024F, top + 0.09F}, {0.002F, top + 0.17F}},
                            sidesOf(detail, 16)));
    append(steel, makeLathe({{0.02F, 0}, {0.028F, 0.015F}, {0.028F, 0.045F}, {0.02F, 0.06F}},
                            sidesOf(detail, 20)));
    addBands(steel, 0.08F, 0.5F, 12, 0.0205F, detail);
    addBands(steel, top - 0.22F, top - 0.07F, 4, 0.0205F, detail);
    return {withNormals(steel, 35), withNormals(makeShaft(0.03F, top + 0.06F, 0.019F, detail), 60)};
}

Arms makePole(float detail) {
    Mesh steel;
    append(steel, makeBlade(kPoleLength - 0.02F, kPoleLength + 0.2F,
                            {0.012F, 0.03F, 0.034F, 0.026F, 0.014F, 0.0008F}, 0.008F));
    append(steel, makeSphere(0.026F, sidesOf(detail, 24), sidesOf(detail, 14)), kUnturned,
           vec3(0, kPoleLength - 0.03F, 0));
    append(steel, makeLathe({{0.001F, 0}, {0.012F, 0.05F}, {0.018F, 0.09F}, {0.015F, 0.1F}},
                            sidesOf(detail, 16)));
    addBands(steel, 1.0F, 1.25F, 8, 0.016F, detail);
    return {withNormals(steel, 35),
            withNormals(makeShaft(0.04F, kPoleLength - 0.03F, 0.0145F, detail), 60)};
}

Arms makeShield(float detail) {
    constexpr float kRadius = 0.33F;
    const auto rise = [](float radius) {
        return 0.075F * (1 - radius * radius / (kRadius * kRadius));
    };
    std::vector<vec2> board;
    const int steps = static_cast<int>(sidesOf(detail, 18));
    for (int i = 1; i <= steps; ++i) {
        const float radius = kRadius * static_cast<float>(i) / static_cast<float>(steps);
        board.emplace_back(radius, rise(radius) - 0.012F);
    }
    for (int i = steps; i >= 1; --i) {
        const float radius = kRadius * static_cast<float>(i) / static_cast<float>(steps);
        board.emplace_back(radius, rise(radius));
    }
    Mesh steel, wood = makeLathe(board, sidesOf(detail, 64));
    append(steel, makeTorus(kRadius, 0.011F, sidesOf(detail, 64), sidesOf(detail, 10)), kUnturned,
           vec3(0, -0.005F, 0));
    std::vector<vec2> boss = {{0.1F, 0.055F}, {0.103F, 0.078F}};
    for (int i = 0; i <= 8; ++i) {
        const float angle = glm::half_pi<float>() * static_cast<float>(i) / 8;
        boss.emplace_back(0.08F * std::cos(angle) + 0.001F, 0.078F + 0.06F * std::sin(angle));
    }
    append(steel, makeLathe(boss, sidesOf(detail, 32)));
    for (int i = 0; i < 12; ++i) {
        const float angle = glm::two_pi<float>() * static_cast<float>(i) / 12;
        const vec3 rivet(0.27F * std::sin(angle), rise(0.27F), 0.27F * std::cos(angle));
        append(steel, makeSphere(0.012F, sidesOf(detail, 10), sidesOf(detail, 6)), kUnturned,
               rivet);
    }
    return {withNormals(steel, 40), withNormals(wood, 40)};
}

Arms makeScabbard(float detail) {
    const Arms sword = makeSword(detail);
    std::vector<SweepRing> rings;
    for (int i = 0; i <= 12; ++i) {
        const float t = static_cast<float>(i) / 12;
        rings.push_back({vec3(0, 0.205F + 0.88F * t, 0), 0.036F - 0.012F * t, 0.014F});
    }
    Mesh steel, wood = makeSweep(rings, vec3(0, 0, 1), sidesOf(detail, 14));
    append(wood, sword.wood);
    append(steel, sword.steel);
    // Hangs with its hilt forward; the hips joint is at the middle of the belt
    const quat tilt = glm::angleAxis(glm::radians(-128.0F), vec3(1, 0, 0)) *
                      glm::angleAxis(glm::half_pi<float>(), vec3(0, 1, 0));
    const vec3 place(0.235F, 0.12F, 0.2F);
    Mesh turnedSteel, turnedWood;
    append(turnedSteel, steel, tilt, place);
    append(turnedWood, wood, tilt, place);
    return {withNormals(turnedSteel, 35), withNormals(turnedWood, 50)};
}

}  // namespace tools
