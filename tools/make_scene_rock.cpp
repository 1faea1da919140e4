// SPDX-License-Identifier: MIT
#include "make_scene_rock.h"

#include "make_scene_field.h"
#include "make_scene_random.h"
#include "make_scene_simplify.h"
#include "make_scene_surface.h"

namespace tools {

using glm::vec3;

namespace {

float roughness(const vec3& p) {
    float sum = 0, height = 0.5F;
    vec3 at = p * 1.3F;
    for (int octave = 0; octave < 5; ++octave) {
        // Folded octaves make ridges, as broken stone has
        sum += height * (1 - 2 * std::abs(noiseAt(at)));
        at = at * 2.07F + vec3(5.3F, 1.7F, 9.1F);
        height *= 0.48F;
    }
    return sum;
}

float roundedBox(const vec3& p, const vec3& centre, const vec3& half, float radius) {
    const vec3 q = glm::abs(p - centre) - half + radius;
    return glm::length(glm::max(q, vec3(0))) + std::min(std::max({q.x, q.y, q.z}), 0.0F) - radius;
}

// Blocks that lean on each other.
float blocksDistance(const vec3& p) {
    const float top = kCliffHeight;
    float d =
        roundedBox(p, {0.1F, 0.5F * top - 0.2F, -0.75F}, {1.75F, 0.5F * top + 0.2F, 1.2F}, 0.12F);
    d = smoothMin(d, roundedBox(p, {-0.9F, 0.55F, 0.2F}, {1.0F, 0.75F, 0.85F}, 0.2F), 0.15F);
    d = smoothMin(d, roundedBox(p, {1.5F, 0.25F, 0.1F}, {0.8F, 0.55F, 0.75F}, 0.2F), 0.15F);
    return smoothMin(d, glm::length(p - vec3(0.7F, 0.1F, 1.35F)) - 0.35F, 0.05F);
}

float cliffDistance(const vec3& p) {
    constexpr float kMostOut = 0.31F, kMostIn = 0.2F;  // of what follows, generously
    const float d = blocksDistance(p);
    if (d > kMostOut + 0.1F) return d - kMostOut;
    if (d < -kMostIn - 0.1F) return d + kMostIn;
    // Beds of stone: each juts out and is undercut; they dip a little and are not level
    const float bed = p.y + 0.09F * p.x + 0.07F * noiseAt(0.9F * p);
    const float layer = bed / 0.42F - std::floor(bed / 0.42F);
    const float jut = 0.13F * smoothStep(0.0F, 0.22F, layer) * (1 - smoothStep(0.75F, 1.0F, layer));
    // The level top stays smooth
    const float calm = smoothStep(kCliffHeight - 0.22F, kCliffHeight - 0.03F, p.y);
    return d - (1 - calm) * (jut + 0.17F * roughness(p)) + 0.02F * calm;
}

std::vector<float> makeSteps(float low, float high, float step) {
    std::vector<float> planes;
    for (float at = low; at < high; at += step) planes.push_back(at);
    return planes;
}

}  // namespace

Mesh makeCliff(size_t triangleCount) {
    constexpr float kStep = 0.027F;
    Mesh mesh = polygonise(cliffDistance, {makeSteps(-2.7F, 3.0F, kStep),
                                           makeSteps(-0.75F, kCliffHeight + 0.35F, kStep),
                                           makeSteps(-2.7F, 2.4F, kStep)});
    std::vector<uint8_t> none;
    simplify(mesh, none, triangleCount);
    return withNormals(mesh, 40);
}

}  // namespace tools
