// SPDX-License-Identifier: MIT
// The walking figure at rest: skeleton, skin as an implicit surface, material regions and joint
// weights. Rest pose: facing +Z, left side at +X, arms 40 degrees from vertical; every joint frame
// is parallel to the world's.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "make_scene_mesh.h"

namespace tools {

enum Joint : uint8_t {
    kHips,
    kSpine,
    kChest,
    kNeck,
    kHead,
    kUpperArmL,
    kLowerArmL,
    kHandL,
    kUpperArmR,
    kLowerArmR,
    kHandR,
    kThighL,
    kShinL,
    kFootL,
    kToesL,
    kThighR,
    kShinR,
    kFootR,
    kToesR,
    kJointCount
};

struct JointInfo {
    std::string_view name;
    int parent;              // -1 for the root
    glm::vec3 restPosition;  // metres, in the figure's space
};

const std::array<JointInfo, kJointCount>& skeleton();

// Left arm's direction at rest, from shoulder to wrist.
glm::vec3 armDirectionL();

// Distance from the wrist to the middle of the fist.
inline constexpr float kGripDistance = 0.072F;

struct FigureMaterial {
    std::string_view name;
    glm::vec3 baseColor;
    float roughness;
};

// One closed skin; the triangles of each material are a list of indices into the same vertices.
struct Figure {
    Mesh skin;  // all triangles
    std::vector<std::array<uint8_t, 4>> joints;
    std::vector<std::array<uint16_t, 4>> weights;  // 65535 in sum
    std::vector<FigureMaterial> materials;
    std::vector<std::vector<uint32_t>> indicesOf;  // [materials]
};

struct FigureStyle {
    bool isArmoured = false;   // plates on the body instead of a coat
    bool hasLeftFist = false;  // the left hand grips; else it hangs open
    float detail = 1;          // samples per length, relative to the built-in figure
    size_t triangleCount = 0;  // even, met exactly by leaving out detail; 0: as sampled
};

Figure makeFigure(const FigureStyle& style = {});

// Smooth weights from the distances to the bones' surfaces, at most four per vertex.
void assignWeights(Figure& figure);

}  // namespace tools
