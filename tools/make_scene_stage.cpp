// SPDX-License-Identifier: MIT
#include "make_scene_stage.h"

#include <cstdio>

namespace tools {

using glm::quat;
using glm::vec3;
using nlohmann::json;

quat yaw(float degrees) {
    return glm::angleAxis(glm::radians(degrees), vec3(0, 1, 0));
}

quat lookFrom(const vec3& eye, const vec3& target) {
    const vec3 back = glm::normalize(eye - target);
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), back));
    return glm::normalize(glm::quat_cast(glm::mat3(right, glm::cross(back, right), back)));
}

json placedNode(std::string_view name, const vec3& translation, const quat& rotation) {
    return {{"name", name}, {"translation", toJson(translation)}, {"rotation", toJson(rotation)}};
}

int addUnder(GltfWriter& writer, int parent, json node) {
    const int index = writer.addNode(std::move(node));
    if (parent < 0) {
        writer.document()["scenes"][0]["nodes"].push_back(index);
    } else {
        writer.addChild(parent, index);
    }
    return index;
}

int addProp(GltfWriter& writer, json node, const Mesh& mesh, int material, int parent) {
    const std::string name = node["name"];
    node["mesh"] = writer.addMesh(name, mesh, material);
    std::printf("%-12s %6zu triangles\n", name.c_str(), mesh.triangleCount());
    return addUnder(writer, parent, std::move(node));
}

void addFloor(GltfWriter& writer, float halfSide) {
    Mesh mesh;
    for (const vec3& corner : {vec3(-1, 0, -1), vec3(-1, 0, 1), vec3(1, 0, 1), vec3(1, 0, -1)}) {
        mesh.positions.push_back(corner * halfSide);
        mesh.normals.emplace_back(0, 1, 0);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    json node = {{"name", "floor"}, {"extras", {{"castShadow", false}}}};
    addProp(writer, node, mesh, writer.addMaterial("floor", {0.58F, 0.57F, 0.55F}, 0.95F));
}

int addSkeleton(GltfWriter& writer, int root) {
    int firstJoint = 0;
    for (int joint = 0; joint < kJointCount; ++joint) {
        const JointInfo& info = skeleton()[joint];
        const vec3 origin = info.parent < 0 ? vec3(0) : skeleton()[info.parent].restPosition;
        const int node = writer.addNode(
            {{"name", info.name}, {"translation", toJson(info.restPosition - origin)}});
        if (joint == 0) firstJoint = node;
        writer.addChild(info.parent < 0 ? root : firstJoint + info.parent, node);
    }
    return firstJoint;
}

void addCamera(GltfWriter& writer, const vec3& eye, const vec3& target, float yfovRad, float aspect,
               int zfar) {
    json camera = placedNode("camera", eye, lookFrom(eye, target));
    camera["camera"] = 0;
    writer.document()["cameras"] = json::array(
        {{{"name", "camera"},
          {"type", "perspective"},
          {"perspective",
           {{"yfov", yfovRad}, {"aspectRatio", aspect}, {"znear", 0.1F}, {"zfar", zfar}}}}});
    addUnder(writer, -1, camera);
}

void addLight(GltfWriter& writer, const StageLight& light) {
    json& document = writer.document();
    json node = placedNode("key", light.position, lookFrom(light.position, light.target));
    node["extensions"]["EXT_lights_area"]["light"] = 0;
    if (light.fovDeg > 0) node["extras"]["fov"] = light.fovDeg;
    if (light.near > 0) node["extras"]["near"] = light.near;
    addUnder(writer, -1, node);
    document["extensionsUsed"] = {"EXT_lights_area"};
    json source = {{"name", "key"},
                   {"type", light.isDisk ? "disk" : "rect"},
                   {"color", {1, 0.96, 0.9}},
                   {"intensity", light.intensity},
                   {"size", light.size}};
    if (!light.isDisk) source["rect"]["aspect"] = 1.0;
    document["extensions"]["EXT_lights_area"]["lights"] = json::array({source});
}

}  // namespace tools
