// SPDX-License-Identifier: MIT
// Plates are solids that stand out from the body by 1 to 3 cm and overlap like lames.
#include "make_scene_armour.h"

#include "make_scene_field.h"
#include "make_scene_figure.h"
#include "make_scene_simplify.h"
#include "make_scene_surface.h"

namespace tools {

using glm::vec3;

namespace {

// Rises over each pitch and falls back quickly: the profile of overlapping lames, 0 .. 1.
float lames(float at, float pitch) {
    const float t = at / pitch - std::floor(at / pitch);
    return t < 0.8F ? t / 0.8F : (1 - t) / 0.2F;
}

float between(float x, float low, float high) {
    return std::max(low - x, x - high);
}

float cuirassDistance(const vec3& p, float torso) {
    const float ridge = p.z > 0 ? std::max(0.0F, 1 - std::abs(p.x) / 0.05F) : 0.0F;
    const float waist = 1 - smoothStep(1.17F, 1.2F, p.y);
    const float plate = torso - 0.013F - 0.008F * ridge - 0.006F * waist * lames(p.y, 0.045F);
    return smoothMax(plate, between(p.y, 1, 1.425F), 0.004F);
}

// A short skirt of lames, slit into strips towards its hem.
float fauldsDistance(const vec3& p) {
    constexpr float kHem = 0.76F, kTop = 1.04F;
    const float flare = std::clamp((kTop - p.y) / (kTop - kHem), 0.0F, 1.2F);
    const glm::vec2 radii =
        glm::mix(glm::vec2(0.145F, 0.112F), glm::vec2(0.225F, 0.17F), std::sqrt(flare));
    const float around = std::atan2(p.z / radii.y, p.x / radii.x);
    const float slits = 0.012F * flare * smoothStep(0.85F, 1.0F, std::abs(std::cos(5 * around)));
    const float cone = (glm::length(glm::vec2(p.x, p.z) / radii) - 1) * 0.5F * (radii.x + radii.y);
    return smoothMax(cone + slits - 0.009F * lames(kTop - p.y, 0.056F), between(p.y, kHem, kTop),
                     0.006F);
}

// `q` is mirrored to the left side.
float armPlatesDistance(const vec3& q) {
    const vec3 along = armDirectionL();
    const vec3 shoulder = skeleton()[kUpperArmL].restPosition;
    const vec3 elbow = skeleton()[kLowerArmL].restPosition;
    const vec3 wrist = skeleton()[kHandL].restPosition;
    float d = 1e9F;
    for (int lame = 0; lame < 4; ++lame) {
        const float step = static_cast<float>(lame);
        const vec3 centre = shoulder + along * (0.002F + 0.036F * step) + vec3(0.006F, 0.006F, 0);
        const float dome = glm::length(q - centre) - (0.09F - 0.006F * step);
        d = std::min(d, smoothMax(dome, glm::dot(q - centre, along) - 0.034F, 0.004F));
    }
    const float reach = glm::dot(q - elbow, along);
    const float cop = glm::length(q - elbow) - 0.058F;
    const float cuffs = capsule(q, elbow - 0.06F * along, elbow + 0.06F * along, 0.056F, 0.052F);
    d = std::min({d, cop, smoothMax(cuffs, std::abs(reach) - 0.05F, 0.004F)});
    const float forearm = capsule(q, elbow, wrist, 0.058F, 0.042F) - 0.004F * lames(-reach, 0.045F);
    return std::min(d, smoothMax(forearm, between(reach, 0.07F, 0.225F), 0.004F));
}

float legPlatesDistance(const vec3& q) {
    const vec3 knee(0.101F, 0.5F, 0.024F);
    float d = ellipsoid(q, knee, {0.074F, 0.066F, 0.072F});
    for (const float step : {-1.0F, 1.0F}) {
        const float lame = glm::length(q - knee - vec3(0, 0.045F * step, -0.012F)) - 0.076F;
        d = std::min(d, smoothMax(lame, std::abs(q.y - knee.y - 0.05F * step) - 0.022F, 0.004F));
    }
    const float thigh = capsule(q, {0.09F, 0.9F, 0}, {0.1F, 0.5F, 0.01F}, 0.095F, 0.075F);
    d = std::min(
        d, smoothMax(thigh - 0.005F * lames(q.y, 0.05F), between(q.y, 0.565F, 0.74F), 0.005F));
    float shin = capsule(q, {0.1F, 0.5F, 0.008F}, {0.106F, 0.3F, -0.015F}, 0.073F, 0.066F);
    shin = smoothMin(
        shin, capsule(q, {0.105F, 0.36F, -0.014F}, {0.11F, 0.1F, -0.02F}, 0.066F, 0.058F), 0.03F);
    if (q.z > 0) shin -= 0.008F * std::max(0.0F, 1 - std::abs(q.x - 0.105F) / 0.025F);
    return std::min(d, smoothMax(shin, between(q.y, 0.135F, 0.44F), 0.005F));
}

float dome(const vec3& p, float inset) {
    return ellipsoid(p, {0, 1.668F, -0.014F}, vec3(0.1F - inset, 0.128F - inset, 0.124F - inset));
}

float hornsDistance(const vec3& q) {
    const vec3 path[] = {{0.08F, 1.715F, -0.01F}, {0.145F, 1.735F, 0},   {0.195F, 1.79F, 0.015F},
                         {0.215F, 1.865F, 0.04F}, {0.2F, 1.935F, 0.07F}, {0.17F, 1.985F, 0.1F}};
    const float radii[] = {0.036F, 0.031F, 0.026F, 0.02F, 0.013F, 0.008F};
    float d = 1e9F;
    for (int i = 0; i < 5; ++i)
        d = smoothMin(d, capsule(q, path[i], path[i + 1], radii[i], radii[i + 1]), 0.008F);
    return d;
}

float helmetDistance(const vec3& p, Helmet kind) {
    const vec3 q(std::abs(p.x), p.y, p.z);
    const float shell = smoothMax(dome(p, 0), -dome(p, 0.01F), 0.004F);
    // The rim rises from the neck to the brow.
    const float rim = glm::mix(1.575F, 1.7F, smoothStep(-0.03F, 0.06F, p.z));
    float d = smoothMax(shell, rim - p.y, 0.004F);
    const float bead = std::max(std::abs(dome(p, 0.003F)) - 0.009F, std::abs(p.y - rim) - 0.008F);
    d = smoothMin(d, bead, 0.004F);
    d = smoothMin(d, capsule(p, {0, 1.715F, 0.103F}, {0, 1.645F, 0.122F}, 0.008F, 0.01F), 0.006F);
    const float cheek = ellipsoid(q, {0.082F, 1.625F, 0.022F}, {0.014F, 0.055F, 0.035F});
    d = smoothMin(d, cheek, 0.01F);
    if (kind == Helmet::horned) return smoothMin(d, hornsDistance(q), 0.01F);
    if (kind == Helmet::spiked)
        return smoothMin(d, capsule(p, {0, 1.785F, -0.014F}, {0, 1.9F, -0.014F}, 0.02F, 0.006F),
                         0.02F);
    // A comb from the brow to the neck, scalloped along its edge.
    const vec3 fromMiddle = p - vec3(0, 1.66F, -0.035F);
    const float angle = std::atan2(fromMiddle.y, fromMiddle.z);
    const float edge =
        glm::length(glm::vec2(fromMiddle.y, fromMiddle.z)) - 0.185F - 0.008F * std::cos(26 * angle);
    const float comb = std::max({edge, q.x - 0.011F, -dome(p, 0.004F), 1.6F - p.y, p.z - 0.09F});
    return smoothMin(d, comb, 0.006F);
}

std::vector<float> makeSteps(float low, float high, float step) {
    std::vector<float> planes;
    for (float at = low; at < high + step; at += step) planes.push_back(at);
    return planes;
}

}  // namespace

float armourDistance(const vec3& p, float torso) {
    const vec3 q(std::abs(p.x), p.y, p.z);
    float d = std::min(cuirassDistance(p, torso), fauldsDistance(p));
    // Far from an arm's or a leg's plates, their own shapes need no look
    if (q.x > 0.08F && p.y > 0.9F) d = std::min(d, armPlatesDistance(q));
    if (p.y < 0.85F) d = std::min(d, legPlatesDistance(q));
    return d;
}

Mesh makeHelmet(Helmet kind, size_t triangleCount) {
    const Field field = [=](const vec3& p) { return helmetDistance(p, kind); };
    constexpr float kStep = 0.005F;
    Mesh mesh =
        polygonise(field, {makeSteps(-0.2601F, 0.26F, kStep), makeSteps(1.5401F, 2.01F, kStep),
                           makeSteps(-0.2401F, 0.16F, kStep)});
    std::vector<uint8_t> none;
    simplify(mesh, none, triangleCount);
    const vec3 head = skeleton()[kHead].restPosition;
    for (vec3& position : mesh.positions) position -= head;
    return withNormals(mesh, 50);
}

}  // namespace tools
