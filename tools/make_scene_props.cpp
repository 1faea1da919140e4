// SPDX-License-Identifier: MIT
// Props with thin and layered parts: bars of 1 cm, leaves in three layers, a hollow pot, a crate of
// planks.
#include "make_scene_props.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "make_scene_random.h"
#include "make_scene_walk.h"

namespace tools {

using glm::vec2;
using glm::vec3;

namespace {

constexpr float kTrellisHalfWidth = 0.5F;
constexpr float kTrellisHeight = 1.75F;
constexpr float kTrellisFoot = 0.12F;  // lowest edge of the lattice
constexpr float kCrateHalf = 0.21F;

glm::quat yaw(float degrees) {
    return glm::angleAxis(glm::radians(degrees), vec3(0, 1, 0));
}

// A leaf on its stalk: rises from the origin, leans outward along +Z and droops at the tip.
Mesh makeLeaf(float length, float halfWidth, float reach, float height) {
    constexpr int kStations = 23;
    std::vector<SweepRing> rings;
    for (int i = 0; i <= kStations; ++i) {
        const float t = static_cast<float>(i) / kStations;
        const float stalk = std::clamp(t / 0.3F, 0.0F, 1.0F);
        const float blade = std::clamp((t - 0.3F) / 0.7F, 0.0F, 1.0F);
        const vec3 centre(0,
                          height * (1 - (1 - stalk) * (1 - stalk)) +
                              length * (0.45F * blade - 0.85F * blade * blade),
                          reach * stalk * stalk + length * (0.95F * blade - 0.12F * blade * blade));
        const float outline = std::sqrt(blade) * (1 - blade) * (1 + 0.55F * blade) * 2.05F;
        rings.push_back(
            {centre, std::max(0.0035F, halfWidth * outline), blade > 0 ? 0.0016F : 0.0035F});
    }
    rings.back().halfHeight = 0.0012F;
    return makeSweep(rings, vec3(1, 0, 0), 8);
}

}  // namespace

Mesh makeHat() {
    // A shallow woven cone, hollow below; the profile goes out under the brim and back up over it.
    std::vector<vec2> profile = {
        {0.004F, 0.176F}, {0.06F, 0.174F}, {0.092F, 0.146F}, {0.1F, 0.121F}};
    constexpr int kSteps = 10;
    const auto brim = [](float t) {
        return vec2(0.1F + 0.115F * t, 0.12F - 0.02F * t - 0.018F * t * t);
    };
    for (int i = 1; i <= kSteps; ++i) profile.push_back(brim(static_cast<float>(i) / kSteps));
    for (int i = kSteps; i >= 2; --i) {
        profile.push_back(brim(static_cast<float>(i) / kSteps) + vec2(0.002F, 0.009F));
    }
    // Crown: a rounded cone.
    for (int i = 0; i <= 16; ++i) {
        const float t = static_cast<float>(i) / 16;
        profile.emplace_back(0.116F * std::pow(1 - t, 0.8F) + 0.003F,
                             0.127F + 0.125F * std::pow(t, 0.92F));
    }
    Mesh hat = makeLathe(profile, 56);
    for (vec3& p : hat.positions) p += vec3(0, 0.026F + 0.16F * p.z, -0.012F);
    return withNormals(hat, 50);
}

Mesh makeStaff() {
    std::vector<SweepRing> rings;
    constexpr int kSegments = 50;
    for (int i = 0; i <= kSegments; ++i) {
        const float t = static_cast<float>(i) / kSegments;
        const float knots = 0.0011F * std::sin(37 * t) + 0.0007F * std::sin(71 * t + 1);
        const float radius = (i == 0 ? 0.009F : 0.012F) + knots;
        const float bend = 0.5F - std::abs(t - 0.5F);
        rings.push_back({vec3(0.012F * std::sin(7.0F * t) * bend, kStaffLength * t,
                              0.01F * std::sin(9 * t) * bend),
                         radius, radius});
    }
    return withNormals(makeSweep(rings, vec3(0, 0, 1), 16), 60);
}

Mesh makeStaffRings() {
    Mesh mesh;
    const glm::quat upright = glm::angleAxis(glm::half_pi<float>(), vec3(1, 0, 0));
    append(mesh, makeTorus(0.075F, 0.0085F, 56, 14), upright, vec3(0, kStaffLength + 0.075F, 0));
    append(mesh, makeSphere(0.019F, 20, 12), glm::quat(1, 0, 0, 0),
           vec3(0, kStaffLength + 0.004F, 0));
    append(mesh, makeSphere(0.014F, 16, 10), glm::quat(1, 0, 0, 0),
           vec3(0, kStaffLength + 0.16F, 0));
    // Two loose rings hang in the big one.
    for (const float side : {-1.0F, 1.0F}) {
        const vec3 centre(side * 0.064F, kStaffLength + 0.012F, 0);
        append(mesh, makeTorus(0.03F, 0.0045F, 32, 10),
               yaw(side * 25) * glm::angleAxis(glm::half_pi<float>(), vec3(0, 0, 1)), centre);
    }
    return withNormals(mesh, 60);
}

Mesh makePot() {
    const std::vector<vec2> profile = {
        {0.105F, 0.0F},   {0.112F, 0.004F}, {0.13F, 0.08F},   {0.148F, 0.16F},  {0.158F, 0.215F},
        {0.172F, 0.218F}, {0.176F, 0.224F}, {0.179F, 0.258F}, {0.175F, 0.265F}, {0.16F, 0.265F},
        {0.155F, 0.26F},  {0.15F, 0.21F},   {0.14F, 0.15F},   {0.12F, 0.1F},
    };
    return withNormals(makeLathe(profile, 48), 45);
}

Mesh makeSoil() {
    Mesh soil = makeLathe({{0.15F, 0.2F}, {0.1525F, 0.228F}, {0.1F, 0.238F}, {0.05F, 0.243F}}, 32);
    return withNormals(soil, 60);
}

Mesh makeLeaves() {
    struct Layer {
        int count;
        float length, halfWidth, reach, height;
    };
    // From the outer, low layer to the inner, high one; turned so that leaves cover the gaps below.
    const Layer layers[] = {
        {10, 0.33F, 0.052F, 0.11F, 0.13F},
        {9, 0.34F, 0.055F, 0.085F, 0.31F},
        {7, 0.3F, 0.05F, 0.05F, 0.47F},
    };
    Mesh mesh;
    Jitter jitter;
    float start = 0;
    for (const Layer& layer : layers) {
        for (int i = 0; i < layer.count; ++i) {
            const float scale = 1 + 0.1F * jitter.next();
            const Mesh leaf = makeLeaf(layer.length * scale, layer.halfWidth * scale, layer.reach,
                                       layer.height * (1 + 0.1F * jitter.next()));
            const float azimuth =
                start + 360.0F * static_cast<float>(i) / static_cast<float>(layer.count);
            const glm::quat turned = yaw(azimuth + 7 * jitter.next());
            append(mesh, leaf, turned, turned * vec3(0, 0.225F, 0.03F));
        }
        start += 17;
    }
    return withNormals(mesh, 70);
}

Mesh makeTrellis() {
    Mesh mesh;
    const float top = kTrellisHeight;
    for (const float side : {-1.0F, 1.0F}) {
        append(mesh, makeBox({side * kTrellisHalfWidth, 0.5F * (top + 0.04F), 0},
                             {0.02F, 0.5F * (top + 0.04F), 0.02F}));
        append(mesh, makeBox({side * kTrellisHalfWidth, 0.02F, 0}, {0.03F, 0.02F, 0.17F}));
    }
    for (const float height : {kTrellisFoot, top}) {
        append(mesh, makeBox({0, height, 0}, {kTrellisHalfWidth - 0.02F, 0.017F, 0.015F}));
    }
    // Two layers of slanted bars, one behind the other, cut off by the frame.
    constexpr float kSpacing = 0.165F;
    const float width = 2 * kTrellisHalfWidth - 0.04F;
    const float rise = top - kTrellisFoot;
    for (const float slope : {-1.0F, 1.0F}) {
        for (float at = -width + 0.5F * kSpacing; at < rise; at += kSpacing) {
            // The bar runs from (0, at) to (width, at + width), measured from the lattice's lower
            // left.
            const float from = std::max(0.0F, -at);
            const float to = std::min(width, rise - at);
            if (to - from < 0.04F) continue;
            const auto place = [&](float t) {
                return vec3(slope * (t - 0.5F * width), kTrellisFoot + at + t, slope * 0.0052F);
            };
            append(mesh, makeBar(place(from), place(to), 0.0052F, 10));
        }
    }
    return withNormals(mesh, 50);
}

Mesh makeCrate() {
    Mesh mesh;
    constexpr float kThickness = 0.014F;
    constexpr float kInner = kCrateHalf - kThickness;
    const vec3 centre(0, kCrateHalf, 0);
    append(mesh, makeBox(centre, vec3(kInner - 0.004F)));
    // Four planks on each upright side, then a frame of posts and rails, then the lid.
    constexpr int kPlanks = 4;
    constexpr float kPitch = 2 * kInner / kPlanks;
    for (int side = 0; side < 4; ++side) {
        const glm::quat turned = yaw(90.0F * static_cast<float>(side));
        Mesh face;
        for (int plank = 0; plank < kPlanks; ++plank) {
            const float height = -kInner + kPitch * (static_cast<float>(plank) + 0.5F);
            append(face, makeBox({0, height, kInner - 0.004F},
                                 {kInner - 0.006F, 0.5F * kPitch - 0.003F, 0.007F}));
        }
        for (const float end : {-1.0F, 1.0F}) {
            append(face, makeBox({0, end * (kCrateHalf - 0.026F), kCrateHalf - 0.007F},
                                 {kInner - 0.003F, 0.026F, 0.007F}));
        }
        append(face,
               makeBox({kCrateHalf - 0.02F, 0, kCrateHalf - 0.009F}, {0.02F, kCrateHalf, 0.011F}));
        append(face, makeBox({-kCrateHalf + 0.02F, 0, kCrateHalf - 0.009F},
                             {0.02F, kCrateHalf, 0.0105F}));
        append(mesh, face, turned, centre);
    }
    for (int plank = 0; plank < kPlanks; ++plank) {
        const float across = -kInner + kPitch * (static_cast<float>(plank) + 0.5F);
        append(mesh, makeBox({across, 2 * kCrateHalf - 0.008F, 0},
                             {0.5F * kPitch - 0.003F, 0.007F, kInner}));
    }
    return withNormals(mesh, 30);
}

}  // namespace tools
