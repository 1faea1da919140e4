// SPDX-License-Identifier: MIT
// What every scene is put together from: nodes, props, a floor that only receives, a skeleton, a
// camera and an area light. Metres, +Y up.
#pragma once

#include "make_scene_gltf.h"

namespace tools {

glm::quat yaw(float degrees);

// Rotation that aims local -Z at the target with +Y up.
glm::quat lookFrom(const glm::vec3& eye, const glm::vec3& target);

nlohmann::json placedNode(std::string_view name, const glm::vec3& translation,
                          const glm::quat& rotation);

// Adds a node to the scene itself (parent -1) or as a child of another one.
int addUnder(GltfWriter& writer, int parent, nlohmann::json node);

// Adds a prop under a parent and prints its size.
int addProp(GltfWriter& writer, nlohmann::json node, const Mesh& mesh, int material,
            int parent = -1);

// A square of the given half side around the origin that casts no shadow.
void addFloor(GltfWriter& writer, float halfSide);

// Adds the figure's joints below a root node; returns the first one, the others follow it.
int addSkeleton(GltfWriter& writer, int root);

struct StageLight {
    glm::vec3 position, target;
    double size;       // metres
    double intensity;  // nits
    bool isDisk = false;
    double fovDeg = 0, near = 0;  // of its views, degrees and metres; 0: fitted by the renderer
};

void addCamera(GltfWriter& writer, const glm::vec3& eye, const glm::vec3& target, float yfovRad,
               float aspect = 1.7777778F, int zfar = 50);
void addLight(GltfWriter& writer, const StageLight& light);

}  // namespace tools
