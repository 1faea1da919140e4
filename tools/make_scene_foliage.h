// SPDX-License-Identifier: MIT
// Sheets, and what is cut out of them: curtains, washing, leaves and wire as alpha textures.
#pragma once

#include "make_scene_gltf.h"

namespace tools {

// Hangs from y + height down to y = 0 in folds, `halfWidth` to both sides; open, to be seen from
// both.
Mesh makeCurtain(float halfWidth, float height, uint32_t columns, uint32_t rows);

// A waving rectangle of exactly so many triangles.
Mesh makeSheet(float width, float height, std::size_t triangleCount);

// A rectangle with texture coordinates from 0 to `repeats`.
Mesh makeTexturedQuad(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b,
                      const glm::vec2& repeats);

// Adds a part with its normals and texture coordinates.
void appendWhole(Mesh& mesh, const Mesh& part);

// Alpha tested, seen from both sides.
int addMaskedMaterial(GltfWriter& writer, std::string_view name, const Picture& picture);

Picture leafPicture();  // a leaf on its stalk, from the bottom to the top
Picture wirePicture();  // one mesh of a wire fence, to be repeated

struct TreeParts {
    Mesh wood;    // closed, without normals
    Mesh leaves;  // textured quads
};
TreeParts makeTreeParts(int leafCount);

}  // namespace tools
