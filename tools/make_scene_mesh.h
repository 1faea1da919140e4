// SPDX-License-Identifier: MIT
// Triangle meshes of make_scene: closed sweeps, solids of revolution, tori and boxes,
// counter-clockwise from outside.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

namespace tools {

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  // empty until withNormals
    std::vector<glm::vec2> uvs;      // empty: no texture
    std::vector<uint32_t> indices;   // [triangles, 3]

    size_t triangleCount() const { return indices.size() / 3; }
};

// One cross-section of a sweep: an ellipse around `centre`, `halfWidth` across and `halfHeight`
// along the up direction.
struct SweepRing {
    glm::vec3 centre;
    float halfWidth;
    float halfHeight;
};

// Sweeps ellipses along the ring centres; both ends are closed by fans.
Mesh makeSweep(const std::vector<SweepRing>& rings, const glm::vec3& up, uint32_t sides);

// A straight round bar of constant radius.
Mesh makeBar(const glm::vec3& from, const glm::vec3& to, float radius, uint32_t sides);

// Turns a profile of (radius, height) around +Y; it starts and ends with a fan, so the outline runs
// bottom to top outside (and back down inside, if hollow).
Mesh makeLathe(const std::vector<glm::vec2>& profile, uint32_t sides);

// A torus around +Y at the origin.
Mesh makeTorus(float majorRadius, float minorRadius, uint32_t majorSides, uint32_t minorSides);

Mesh makeSphere(float radius, uint32_t sides, uint32_t rings);
Mesh makeBox(const glm::vec3& centre, const glm::vec3& halfExtents);

// A box with its edges and corners cut off; 44 triangles.
Mesh makeBlock(const glm::vec3& centre, const glm::vec3& half, float cut);

// Adds a bar whose ends reach further than asked, each bar by another part of its radius: bars that
// meet would share edges otherwise, and the mesh would not be closed.
void addStrut(Mesh& mesh, const glm::vec3& from, const glm::vec3& to, float radius, uint32_t sides);

// Adds `part`, rotated and then moved, to `mesh` (before normals).
void append(Mesh& mesh, const Mesh& part, const glm::quat& rotation = glm::quat(1, 0, 0, 0),
            const glm::vec3& translation = glm::vec3(0));

// Smooth normals, weighted by area, across edges flatter than the crease angle; vertices on creases
// are doubled.
Mesh withNormals(const Mesh& mesh, float creaseAngleDeg);

}  // namespace tools
