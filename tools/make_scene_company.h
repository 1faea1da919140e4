// SPDX-License-Identifier: MIT
// Figures with what they wear and carry, brought to an exact number of triangles.
#pragma once

#include "make_scene_armour.h"
#include "make_scene_gltf.h"

namespace tools {

enum class Weapon { pole, sword, spear, hammer, staff };

// One figure. Poles and staffs are walked with, other weapons fought with; a sword comes with a
// shield, a pole with a flag and a scabbard.
struct Actor {
    Weapon weapon;
    Helmet helmet;
    glm::vec3 place{0};  // on the ground
    float yawDeg = 0;
    float scale = 1;
    float startSeconds = 0;  // into the loop
    glm::vec3 cloth{0.5F};   // colour of flag, cape and coat
    bool hasCape = true;
};

struct Company {
    FigureStyle style;  // its triangleCount is set to what the rest leaves
    std::vector<Actor> actors;
    float detail = 1;            // of what they carry
    uint32_t clothColumns = 40;  // of a cape; a flag is as fine
    size_t helmetTriangles = 8000;
    int loops = 1;             // of their motion
    size_t triangleCount = 0;  // of all
};

// Throws std::runtime_error where the count cannot be met.
void addCompany(GltfWriter& writer, const Company& company);

}  // namespace tools
