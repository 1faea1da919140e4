// SPDX-License-Identifier: MIT
// Random numbers and noise that are the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace tools {

class Jitter {
  public:
    explicit Jitter(uint32_t seed = 2463534242U) : state_(seed) {}

    // Uniform in -1 .. 1. One call per expression: the order within one differs between compilers.
    float next() {
        state_ = state_ * 1664525U + 1013904223U;
        return static_cast<float>(state_ >> 8U) / 8388608.0F - 1;
    }

    // Uniform in low .. high.
    float within(float low, float high) { return low + (high - low) * 0.5F * (1 + next()); }

    // Uniform in a cube of half side 1.
    glm::vec3 nextVector() {
        glm::vec3 v;
        for (int axis = 0; axis < 3; ++axis) v[axis] = next();
        return v;
    }

  private:
    uint32_t state_;
};

// Value noise in -1 .. 1 with a smooth slope.
inline float noiseAt(const glm::vec3& p) {
    const glm::vec3 cell = glm::floor(p);
    const glm::vec3 t = (p - cell) * (p - cell) * (3.0F - 2.0F * (p - cell));
    const auto corner = [&](int dx, int dy, int dz) {
        uint32_t hash = static_cast<uint32_t>(static_cast<int>(cell.x) + dx) * 73856093U ^
                        static_cast<uint32_t>(static_cast<int>(cell.y) + dy) * 19349663U ^
                        static_cast<uint32_t>(static_cast<int>(cell.z) + dz) * 83492791U;
        hash = (hash ^ (hash >> 13U)) * 1274126177U;
        return static_cast<float>((hash ^ (hash >> 16U)) & 0xFFFFU) / 32767.5F - 1;
    };
    const auto along = [&](int dy, int dz) {
        return glm::mix(corner(0, dy, dz), corner(1, dy, dz), t.x);
    };
    return glm::mix(glm::mix(along(0, 0), along(1, 0), t.y),
                    glm::mix(along(0, 1), along(1, 1), t.y), t.z);
}

}  // namespace tools
