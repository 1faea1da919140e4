// SPDX-License-Identifier: MIT
// Implicit shapes, negative inside, and their blends.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace tools {

// Polynomial smooth minimum (Quilez); k is the width of the blend in metres.
inline float smoothMin(float a, float b, float k) {
    const float h = std::max(k - std::abs(a - b), 0.0F) / k;
    return std::min(a, b) - h * h * k * 0.25F;
}

inline float smoothMax(float a, float b, float k) {
    return -smoothMin(-a, -b, k);
}

inline float smoothStep(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0F, 1.0F);
    return t * t * (3 - 2 * t);
}

// A bump of height 1 around `middle`, zero beyond `reach`.
inline float bump(float x, float middle, float reach) {
    return 1 - smoothStep(0.35F * reach, reach, std::abs(x - middle));
}

inline float ellipsoid(const glm::vec3& p, const glm::vec3& centre, const glm::vec3& radii) {
    const glm::vec3 scaled = (p - centre) / radii;
    const float k0 = glm::length(scaled);
    const float k1 = glm::length(scaled / radii);
    return k1 > 0 ? k0 * (k0 - 1) / k1 : -std::min({radii.x, radii.y, radii.z});
}

inline float capsule(const glm::vec3& p, const glm::vec3& a, const glm::vec3& b, float radiusA,
                     float radiusB) {
    const glm::vec3 axis = b - a;
    const float share = std::clamp(glm::dot(p - a, axis) / glm::dot(axis, axis), 0.0F, 1.0F);
    return glm::length(p - a - axis * share) - glm::mix(radiusA, radiusB, share);
}

}  // namespace tools
