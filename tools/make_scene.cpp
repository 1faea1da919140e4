// SPDX-License-Identifier: MIT
// make_scene OUT.glb: writes the built-in scene, a walking figure among thin and layered occluders
// under one area light. Metres, +Y up, the figure faces +Z. Everything is computed here; the bytes
// never change.
#include <cstdio>
#include <exception>
#include <iostream>

#include "make_scene_gltf.h"
#include "make_scene_props.h"

namespace tools {

namespace {

using glm::quat;
using glm::vec3;
using nlohmann::json;

constexpr float kFloorHalf = 6;
constexpr float kFigureYawDeg = 22;

quat yaw(float degrees) {
    return glm::angleAxis(glm::radians(degrees), vec3(0, 1, 0));
}

// Rotation that aims local -Z at the target with +Y up.
quat lookFrom(const vec3& eye, const vec3& target) {
    const vec3 back = glm::normalize(eye - target);
    const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), back));
    return glm::normalize(glm::quat_cast(glm::mat3(right, glm::cross(back, right), back)));
}

json placedNode(const char* name, const vec3& translation, const quat& rotation) {
    return {{"name", name}, {"translation", toJson(translation)}, {"rotation", toJson(rotation)}};
}

// Adds a prop as a child of the scene (parent -1) or of another node, and prints its size.
int addProp(GltfWriter& writer, json node, const Mesh& mesh, int material, int parent = -1) {
    const std::string name = node["name"];
    node["mesh"] = writer.addMesh(name, mesh, material);
    const int index = writer.addNode(std::move(node));
    if (parent < 0) {
        writer.document()["scenes"][0]["nodes"].push_back(index);
    } else {
        writer.addChild(parent, index);
    }
    std::printf("%-12s %6zu triangles\n", name.c_str(), mesh.triangleCount());
    return index;
}

void addFloor(GltfWriter& writer) {
    Mesh mesh;
    for (const vec3& corner : {vec3(-1, 0, -1), vec3(-1, 0, 1), vec3(1, 0, 1), vec3(1, 0, -1)}) {
        mesh.positions.push_back(corner * kFloorHalf);
        mesh.normals.emplace_back(0, 1, 0);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    json node = {{"name", "floor"}, {"extras", {{"castShadow", false}}}};
    addProp(writer, node, mesh, writer.addMaterial("floor", {0.58F, 0.57F, 0.55F}, 0.95F));
}

void addFigure(GltfWriter& writer) {
    const Figure figure = makeFigure();
    const int root = writer.addNode({{"name", "figure"}, {"rotation", toJson(yaw(kFigureYawDeg))}});
    int firstJoint = 0;
    for (int joint = 0; joint < kJointCount; ++joint) {
        const JointInfo& info = skeleton()[joint];
        const vec3 origin = info.parent < 0 ? vec3(0) : skeleton()[info.parent].restPosition;
        const int node = writer.addNode(
            {{"name", info.name}, {"translation", toJson(info.restPosition - origin)}});
        if (joint == 0) firstJoint = node;
        writer.addChild(info.parent < 0 ? root : firstJoint + info.parent, node);
    }
    const int mesh = writer.addFigureMesh("skin", figure);
    const int skin = writer.addSkin("figure", firstJoint);
    const int body = writer.addNode({{"name", "skin"}, {"mesh", mesh}, {"skin", skin}});
    writer.document()["scenes"][0]["nodes"].push_back(root);
    writer.document()["scenes"][0]["nodes"].push_back(body);
    writer.addWalk("walk", makeWalk(), firstJoint);
    std::printf("%-12s %6zu triangles\n", "skin", figure.skin.triangleCount());

    const int straw = writer.addMaterial("straw", {0.66F, 0.5F, 0.27F}, 0.9F);
    addProp(writer, {{"name", "hat"}}, makeHat(), straw, firstJoint + kHead);
    const int wood = writer.addMaterial("staff", {0.27F, 0.16F, 0.09F}, 0.7F);
    const int brass = writer.addMaterial("brass", {0.72F, 0.52F, 0.2F}, 0.45F);
    const int hand = firstJoint + kHandR;
    addProp(writer, placedNode("staff", staffTranslation(), staffRotation()), makeStaff(), wood,
            hand);
    addProp(writer, placedNode("staffRings", staffTranslation(), staffRotation()), makeStaffRings(),
            brass, hand);
}

void addProps(GltfWriter& writer) {
    const int clay = writer.addMaterial("clay", {0.6F, 0.29F, 0.18F}, 0.85F);
    const int soil = writer.addMaterial("soil", {0.08F, 0.055F, 0.04F}, 1);
    const int leaf = writer.addMaterial("leaf", {0.19F, 0.38F, 0.13F}, 0.7F);
    const int white = writer.addMaterial("paint", {0.78F, 0.77F, 0.73F}, 0.8F);
    const int plank = writer.addMaterial("plank", {0.56F, 0.38F, 0.21F}, 0.85F);
    const int blue = writer.addMaterial("blue", {0.16F, 0.27F, 0.48F}, 0.6F);
    const int ochre = writer.addMaterial("ochre", {0.72F, 0.48F, 0.15F}, 0.7F);

    const vec3 plantPlace(1.7F, 0, 0.7F);
    const quat plantTurn = yaw(20);
    addProp(writer, placedNode("pot", plantPlace, plantTurn), makePot(), clay);
    addProp(writer, placedNode("soil", plantPlace, plantTurn), makeSoil(), soil);
    addProp(writer, placedNode("leaves", plantPlace, plantTurn), makeLeaves(), leaf);
    addProp(writer, placedNode("trellis", {-1.15F, 0, -0.45F}, yaw(4)), makeTrellis(), white);
    addProp(writer, placedNode("crate", {-0.8F, 0, 0.75F}, yaw(24)), makeCrate(), plank);
    addProp(writer, placedNode("sphere", {0.85F, 0.17F, 1.0F}, yaw(0)),
            withNormals(makeSphere(0.17F, 72, 36), 60), blue);
    addProp(writer, placedNode("torus", {0.1F, 0.062F, 1.35F}, yaw(0)),
            withNormals(makeTorus(0.17F, 0.062F, 72, 32), 60), ochre);
}

void addCameraAndLight(GltfWriter& writer) {
    json& document = writer.document();
    const vec3 eye(1.95F, 2.15F, 4.15F);
    json camera = placedNode("camera", eye, lookFrom(eye, {0.55F, 0.74F, -0.2F}));
    camera["camera"] = 0;
    document["cameras"] = json::array(
        {{{"name", "camera"},
          {"type", "perspective"},
          {"perspective",
           {{"yfov", 0.698F}, {"aspectRatio", 1.7777778F}, {"znear", 0.1F}, {"zfar", 50}}}}});
    document["scenes"][0]["nodes"].push_back(writer.addNode(camera));

    const vec3 lamp(-2.65F, 3.35F, 1.5F);
    json light = placedNode("key", lamp, lookFrom(lamp, {0, 1.25F, 0}));
    light["extensions"]["EXT_lights_area"]["light"] = 0;
    document["scenes"][0]["nodes"].push_back(writer.addNode(light));
    document["extensionsUsed"] = {"EXT_lights_area"};
    document["extensions"]["EXT_lights_area"]["lights"] =
        json::array({{{"name", "key"},
                      {"type", "rect"},
                      {"color", {1, 0.96, 0.9}},
                      {"intensity", 120.0},
                      {"size", 0.8},
                      {"rect", {{"aspect", 1.0}}}}});
}

void run(const std::string& path) {
    GltfWriter writer;
    writer.document()["scene"] = 0;
    writer.document()["scenes"] = json::array({{{"name", "walk"}, {"nodes", json::array()}}});
    addFloor(writer);
    addFigure(writer);
    addProps(writer);
    addCameraAndLight(writer);
    std::printf("%zu bytes\n", writer.write(path));
}

}  // namespace

}  // namespace tools

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: make_scene OUT.glb\n";
        return 2;
    }
    try {
        tools::run(argv[1]);
    } catch (const std::exception& error) {
        std::cerr << "make_scene: " << error.what() << "\n";
        return 1;
    }
    return 0;
}
