// SPDX-License-Identifier: MIT
// Turns an implicit surface (negative inside) into a closed mesh by surface nets, and cuts it along
// other fields.
#pragma once

#include <functional>

#include "make_scene_mesh.h"

namespace tools {

using Field = std::function<float(const glm::vec3&)>;

// Coordinates of the sampling planes, ascending; the spacing may vary.
struct SampleGrid {
    std::vector<float> x, y, z;
};

// Central differences; not normalised.
glm::vec3 computeGradient(const Field& field, const glm::vec3& position, float step);

std::vector<glm::vec3> normalsOf(const Field& surface, const std::vector<glm::vec3>& positions);

// Surface nets (Gibson 1998): one vertex per cell the surface crosses, one quad per crossed grid
// edge. Vertices are then moved onto the surface by Newton steps, which keeps thin features the
// averaging would round off.
Mesh polygonise(const Field& surface, const SampleGrid& grid);

// Cuts triangles where `border` changes sign, so that a border between materials is a smooth line.
// Vertices closer to the border than `snapDistance` move onto it instead, which avoids slivers. The
// mesh stays closed.
void cutAlong(Mesh& mesh, const Field& border, const Field& surface, float snapDistance);

}  // namespace tools
