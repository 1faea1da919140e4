// SPDX-License-Identifier: MIT
// Flags and capes: thin sheets on a chain of joints that wave.
#pragma once

#include "make_scene_figure.h"

namespace tools {

struct Cloth {
    Mesh mesh;
    std::vector<std::array<uint8_t, 4>> joints;
    std::vector<std::array<uint16_t, 4>> weights;  // 65535 in sum
    std::vector<glm::vec3>
        jointPositions;  // the chain at rest; each joint's parent is the one before
    glm::vec3 hinge;     // axis about which each joint turns
    float swingDeg;      // of the first joint; later ones turn further
};

// Along +X from a pole on the Y axis, `columns` x `rows` quads; its last triangle is a free corner.
Cloth makeFlag(uint32_t columns, uint32_t rows, float low, float high, float length);

// Hangs from the shoulders, in the chest joint's space.
Cloth makeCape(uint32_t columns, uint32_t rows);

// Turns of each joint of the chain at the given times; loops over `loopSeconds`.
std::vector<std::vector<glm::quat>> waveCloth(const Cloth& cloth, const std::vector<float>& times,
                                              float loopSeconds, float shiftSeconds);

}  // namespace tools
