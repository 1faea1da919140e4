// SPDX-License-Identifier: MIT
// Body: smooth union of ellipsoids and tapered capsules; clothes are thicker skin with a step at
// the hem.
#include "make_scene_figure.h"

#include <algorithm>
#include <cmath>

#include "make_scene_armour.h"
#include "make_scene_field.h"
#include "make_scene_simplify.h"
#include "make_scene_surface.h"

namespace tools {

using glm::vec3;

namespace {

constexpr float kHemHeight = 0.735F;
constexpr float kBeltHeight = 1.035F;
constexpr float kBootHeight = 0.315F;

vec3 mirror(const vec3& p) {
    return vec3(-p.x, p.y, p.z);
}

float torsoDistance(const vec3& p) {
    const vec3 q(std::sqrt(p.x * p.x + 0.0006F), p.y, p.z);  // mirrored without a crease
    float d = ellipsoid(p, {0, 1.28F, 0.002F}, {0.152F, 0.2F, 0.108F});
    d = smoothMin(d, ellipsoid(p, {0, 1.08F, 0.002F}, {0.13F, 0.16F, 0.096F}), 0.06F);
    d = smoothMin(d, ellipsoid(p, {0, 0.95F, -0.004F}, {0.152F, 0.115F, 0.108F}), 0.06F);
    d = smoothMin(d, ellipsoid(q, {0.07F, 0.91F, -0.045F}, {0.08F, 0.09F, 0.075F}), 0.04F);
    d = smoothMin(d, ellipsoid(q, {0.055F, 1.325F, 0.045F}, {0.1F, 0.08F, 0.062F}), 0.07F);
    d = smoothMin(d, capsule(q, {0, 1.405F, -0.012F}, {0.15F, 1.405F, -0.012F}, 0.065F, 0.052F),
                  0.06F);
    d = smoothMin(d, capsule(q, {0.02F, 1.475F, -0.02F}, {0.15F, 1.42F, -0.015F}, 0.045F, 0.035F),
                  0.05F);
    return smoothMin(d, capsule(p, {0, 1.42F, -0.02F}, {0, 1.57F, 0.002F}, 0.06F, 0.054F), 0.05F);
}

float headDistance(const vec3& p) {
    const vec3 q(std::abs(p.x), p.y, p.z);
    float d = ellipsoid(p, {0, 1.668F, -0.008F}, {0.078F, 0.1F, 0.097F});
    d = smoothMin(d, ellipsoid(p, {0, 1.598F, 0.028F}, {0.057F, 0.072F, 0.062F}), 0.05F);
    d = smoothMin(d, ellipsoid(p, {0, 1.54F, 0.063F}, {0.022F, 0.016F, 0.018F}), 0.03F);
    d = smoothMin(d, capsule(q, {0, 1.69F, 0.079F}, {0.04F, 1.687F, 0.066F}, 0.013F, 0.01F), 0.02F);
    d = smoothMax(d, -ellipsoid(q, {0.034F, 1.664F, 0.093F}, {0.021F, 0.015F, 0.02F}), 0.018F);
    d = smoothMin(d, capsule(p, {0, 1.672F, 0.087F}, {0, 1.637F, 0.101F}, 0.008F, 0.0125F), 0.014F);
    d = smoothMin(d, capsule(q, {0, 1.596F, 0.089F}, {0.018F, 1.597F, 0.082F}, 0.006F, 0.004F),
                  0.012F);
    // Ears, and hair that fills out the back of the head.
    d = smoothMin(d, ellipsoid(q, {0.08F, 1.645F, -0.008F}, {0.013F, 0.033F, 0.02F}), 0.012F);
    return smoothMin(d, ellipsoid(p, {0, 1.632F, -0.05F}, {0.081F, 0.1F, 0.07F}), 0.03F);
}

// `p` is mirrored to the left side. The right hand is a fist around the staff, the left one hangs
// open.
float armDistance(const vec3& p, bool isFist) {
    const vec3 along = armDirectionL();
    const vec3 shoulder = skeleton()[kUpperArmL].restPosition;
    const vec3 elbow = skeleton()[kLowerArmL].restPosition;
    const vec3 wrist = skeleton()[kHandL].restPosition;
    float d = ellipsoid(p, shoulder + vec3(-0.004F, -0.012F, 0), {0.066F, 0.075F, 0.064F});
    d = smoothMin(d, capsule(p, shoulder, elbow, 0.056F, 0.045F), 0.03F);
    d = smoothMin(d, capsule(p, elbow, wrist, 0.046F, 0.031F), 0.03F);
    const float sleeve = glm::dot(p - wrist, along);
    d -= 0.011F * smoothStep(-0.14F, -0.03F, sleeve) * (1 - smoothStep(-0.018F, -0.006F, sleeve));
    const vec3 inward = glm::normalize(glm::cross(along, vec3(0, 0, 1)));  // towards the palm
    if (isFist) {
        const vec3 middle = wrist + kGripDistance * along;
        d = smoothMin(d, ellipsoid(p, middle, {0.044F, 0.044F, 0.046F}), 0.03F);
        d = smoothMin(
            d,
            capsule(p, middle + 0.022F * inward - 0.024F * along + vec3(0, 0, 0.034F),
                    middle + 0.034F * inward + 0.016F * along + vec3(0, 0, 0.03F), 0.013F, 0.011F),
            0.012F);
        for (int finger = 0; finger < 4; ++finger) {
            const vec3 base = middle + vec3(0, 0, 0.027F - 0.019F * static_cast<float>(finger));
            d = smoothMin(d,
                          capsule(p, base + 0.04F * along - 0.012F * inward,
                                  base + 0.03F * along + 0.032F * inward, 0.0115F, 0.0105F),
                          0.006F);
        }
        return d;
    }
    d = smoothMin(d, capsule(p, wrist, wrist + 0.06F * along, 0.024F, 0.022F), 0.02F);
    d = smoothMin(d,
                  capsule(p, wrist + 0.055F * along + vec3(0, 0, 0.016F),
                          wrist + 0.055F * along - vec3(0, 0, 0.02F), 0.021F, 0.019F),
                  0.02F);
    for (int finger = 0; finger < 4; ++finger) {
        const float across = 0.0285F - 0.0195F * static_cast<float>(finger);
        const float length = finger == 3 ? 0.062F : 0.078F;
        const vec3 base = wrist + 0.07F * along + vec3(0, 0, across);
        const vec3 knuckle = base + 0.55F * length * along + 0.008F * inward;
        d = smoothMin(d, capsule(p, base, knuckle, 0.0105F, 0.0098F), 0.008F);
        d = smoothMin(
            d, capsule(p, knuckle, base + length * along + 0.024F * inward, 0.0098F, 0.0085F),
            0.004F);
    }
    return smoothMin(
        d,
        capsule(p, wrist + 0.025F * along + vec3(0, 0, 0.022F),
                wrist + 0.075F * along + 0.022F * inward + vec3(0, 0, 0.05F), 0.0145F, 0.0105F),
        0.012F);
}

float legDistance(const vec3& p) {
    float d = capsule(p, {0.09F, 0.9F, 0}, {0.1F, 0.5F, 0.01F}, 0.082F, 0.062F);
    d = smoothMin(d, capsule(p, {0.1F, 0.5F, 0.008F}, {0.106F, 0.3F, -0.015F}, 0.061F, 0.054F),
                  0.03F);
    d = smoothMin(d, capsule(p, {0.105F, 0.36F, -0.014F}, {0.11F, 0.1F, -0.02F}, 0.054F, 0.042F),
                  0.03F);
    d -= 0.012F * smoothStep(kBootHeight - 0.2F, kBootHeight - 0.02F, p.y) *
         (1 - smoothStep(kBootHeight - 0.005F, kBootHeight + 0.008F, p.y));
    float foot = capsule(p, {0.11F, 0.032F, -0.045F}, {0.114F, 0.026F, 0.11F}, 0.045F, 0.046F);
    foot = smoothMin(
        foot, capsule(p, {0.11F, 0.085F, -0.02F}, {0.114F, 0.035F, 0.1F}, 0.045F, 0.035F), 0.03F);
    foot = smoothMin(foot, ellipsoid(p, {0.116F, 0.025F, 0.135F}, {0.048F, 0.036F, 0.062F}), 0.03F);
    return smoothMax(smoothMin(d, foot, 0.035F), -p.y, 0.008F);
}

// Distance to the middle of the scarf: a ring around the neck, lower in front.
float scarfRing(const vec3& p) {
    const vec3 q = p - vec3(0, 1.487F - 0.22F * p.z, -0.006F);
    return glm::length(glm::vec2(glm::length(glm::vec2(q.x, q.z)) - 0.066F, q.y * 0.8F));
}

// The coat: a layer on the trunk, and below the belt a flared cone that ends at the hem.
float coatDistance(const vec3& p, float trunk) {
    trunk -= 0.007F * (1 - smoothStep(1.42F, 1.5F, p.y)) * smoothStep(0.85F, 0.95F, p.y);
    return trunk - 0.007F * bump(p.y, kBeltHeight, 0.032F);
}

float skirtDistance(const vec3& p) {
    const float flare = std::clamp((1.03F - p.y) / (1.03F - kHemHeight), 0.0F, 1.2F);
    const glm::vec2 radii =
        glm::mix(glm::vec2(0.128F, 0.095F), glm::vec2(0.222F, 0.168F), std::sqrt(flare));
    const float folds = 0.006F * flare * std::cos(12 * std::atan2(p.z / radii.y, p.x / radii.x));
    float skirt =
        (glm::length(glm::vec2(p.x, p.z) / radii) - 1) * 0.5F * (radii.x + radii.y) + folds;
    return smoothMax(skirt, std::max(kHemHeight - p.y, p.y - 1.03F), 0.01F);
}

float bodyDistance(const vec3& p, const FigureStyle& style) {
    const vec3 q(std::abs(p.x), p.y, p.z);
    const float torso = torsoDistance(p);
    const float trunk = style.isArmoured ? torso : coatDistance(p, torso);
    float d = smoothMin(legDistance(p), legDistance(mirror(p)), 0.015F);
    d = smoothMin(trunk, d, 0.045F);
    if (!style.isArmoured) d = smoothMin(d, skirtDistance(p), 0.008F);
    d = smoothMin(d, armDistance(q, p.x < 0 || style.hasLeftFist), 0.028F);
    if (style.isArmoured) d = smoothMin(d, armourDistance(p, torso), 0.003F);
    d = smoothMin(d, scarfRing(p) - 0.027F, 0.012F);
    return smoothMin(d, headDistance(p), 0.018F);
}

// Sampling planes: fine steps within the given range, coarse ones elsewhere.
std::vector<float> makePlanes(float low, float high, const std::function<float(float)>& step) {
    std::vector<float> planes;
    for (float at = low; at < high; at += step(at)) planes.push_back(at);
    return planes;
}

float scarfBorder(const vec3& p) {
    return scarfRing(p) - 0.031F;
}

float handBorder(const vec3& p) {
    const float x = std::abs(p.x);
    const float beyondWrist =
        glm::dot(vec3(x, p.y, p.z) - skeleton()[kHandL].restPosition, armDirectionL());
    return std::max(-0.008F - beyondWrist, 0.3F - x);
}

// Head and neck, not the shoulders beyond the scarf.
float neckBorder(const vec3& p) {
    return 1.487F - p.y + std::max(glm::length(glm::vec2(p.x, p.z)) - 0.075F, 0.0F);
}

float hairBorder(const vec3& p) {
    return p.z - std::max(-0.03F, 0.3F * (p.y - 1.69F) - 0.012F) -
           0.5F * std::max(p.y - 1.71F, 0.0F);
}

// Regions, first match wins; negative inside.
struct Region {
    FigureMaterial material;
    Field border;
};

std::vector<Region> makeCoatRegions() {
    const auto coat = [](const vec3& p) { return kHemHeight - p.y; };
    const auto belt = [](const vec3& p) {
        return std::max(std::abs(p.y - kBeltHeight) - 0.022F, std::abs(p.x) - 0.3F);
    };
    return {
        {{"scarf", {0.62F, 0.17F, 0.09F}, 0.9F}, scarfBorder},
        {{"hair", {0.09F, 0.055F, 0.035F}, 0.75F},
         [](const vec3& p) { return std::max(hairBorder(p), neckBorder(p)); }},
        {{"skin", {0.71F, 0.49F, 0.37F}, 0.6F},
         [](const vec3& p) { return std::min(handBorder(p), neckBorder(p)); }},
        {{"boots", {0.17F, 0.095F, 0.055F}, 0.65F},
         [](const vec3& p) { return p.y - kBootHeight; }},
        {{"belt", {0.13F, 0.07F, 0.04F}, 0.55F}, belt},
        {{"coat", {0.12F, 0.27F, 0.33F}, 0.9F}, coat},
        {{"trousers", {0.4F, 0.35F, 0.27F}, 0.92F}, [](const vec3&) { return -1.0F; }},
    };
}

std::vector<Region> makeArmourRegions() {
    const auto steel = [](const vec3& p) { return armourDistance(p, torsoDistance(p)) - 0.003F; };
    const auto face = [](const vec3& p) { return neckBorder(p); };
    return {
        {{"collar", {0.2F, 0.2F, 0.22F}, 0.5F}, scarfBorder},
        {{"hair", {0.09F, 0.055F, 0.035F}, 0.75F},
         [](const vec3& p) { return std::max(hairBorder(p), neckBorder(p)); }},
        {{"skin", {0.71F, 0.49F, 0.37F}, 0.6F}, face},
        {{"steel", {0.46F, 0.47F, 0.5F}, 0.4F}, steel},
        {{"gloves", {0.2F, 0.12F, 0.07F}, 0.7F}, handBorder},
        {{"boots", {0.17F, 0.095F, 0.055F}, 0.65F},
         [](const vec3& p) { return p.y - kBootHeight; }},
        {{"gambeson", {0.35F, 0.09F, 0.07F}, 0.9F}, [](const vec3& p) { return kHemHeight - p.y; }},
        {{"trousers", {0.3F, 0.27F, 0.22F}, 0.92F}, [](const vec3&) { return -1.0F; }},
    };
}

// The first region that holds each triangle's middle.
std::vector<uint8_t> findRegions(const Mesh& skin, const std::vector<Region>& regions) {
    std::vector<uint8_t> labels;
    for (size_t t = 0; t < skin.indices.size(); t += 3) {
        const uint32_t* corner = &skin.indices[t];
        const vec3 centre =
            (skin.positions[corner[0]] + skin.positions[corner[1]] + skin.positions[corner[2]]) /
            3.0F;
        uint8_t match = 0;
        while (regions[match].border(centre) >= 0) ++match;
        labels.push_back(match);
    }
    return labels;
}

void assignMaterials(Figure& figure, const std::vector<Region>& regions,
                     const std::vector<uint8_t>& labels) {
    for (const Region& region : regions) figure.materials.push_back(region.material);
    figure.indicesOf.resize(regions.size());
    for (size_t t = 0; t < labels.size(); ++t) {
        const uint32_t* corner = &figure.skin.indices[3 * t];
        auto& indices = figure.indicesOf[labels[t]];
        indices.insert(indices.end(), corner, corner + 3);
    }
}

SampleGrid makeGrid(float detail) {
    SampleGrid grid;
    grid.x = makePlanes(-0.72F, 0.72F, [=](float x) {
        const float distance = std::abs(x + 0.0001F);
        return (distance < 0.1F ? 0.0085F : distance < 0.45F ? 0.0128F : 0.0089F) / detail;
    });
    grid.y = makePlanes(-0.0301F, 1.82F, [=](float y) {
        return (y > 1.5F                               ? 0.0081F
                : (y > 0.8F && y < 1.01F) || y < 0.12F ? 0.0104F
                                                       : 0.0145F) /
               detail;
    });
    grid.z = makePlanes(-0.2501F, 0.26F,
                        [=](float z) { return (z > 0.05F ? 0.0094F : 0.012F) / detail; });
    return grid;
}

}  // namespace

Figure makeFigure(const FigureStyle& style) {
    const Field body = [&](const vec3& p) { return bodyDistance(p, style); };
    const std::vector<Region> regions = style.isArmoured ? makeArmourRegions() : makeCoatRegions();
    Figure figure;
    figure.skin = polygonise(body, makeGrid(style.detail));
    for (size_t i = 0; i + 1 < regions.size(); ++i) {
        cutAlong(figure.skin, regions[i].border, body, 0.003F / style.detail);
    }
    std::vector<uint8_t> labels = findRegions(figure.skin, regions);
    if (style.triangleCount > 0) {
        simplify(figure.skin, labels, style.triangleCount);
        figure.skin.normals = normalsOf(body, figure.skin.positions);
    }
    assignMaterials(figure, regions, labels);
    assignWeights(figure);
    return figure;
}

}  // namespace tools
