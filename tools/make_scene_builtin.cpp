// SPDX-License-Identifier: MIT
// The built-in scene: a walking figure among thin and layered occluders under one area light. The
// figure faces +Z. Its bytes never change.
#include <cstdio>

#include "make_scene_props.h"
#include "make_scene_scenes.h"
#include "make_scene_stage.h"
#include "make_scene_walk.h"

namespace tools {

namespace {

using glm::quat;
using glm::vec3;

constexpr float kFloorHalf = 6;
constexpr float kFigureYawDeg = 22;

void addFigure(GltfWriter& writer) {
    const Figure figure = makeFigure();
    const int root = writer.addNode({{"name", "figure"}, {"rotation", toJson(yaw(kFigureYawDeg))}});
    const int firstJoint = addSkeleton(writer, root);
    const int mesh = writer.addFigureMesh("skin", figure);
    const int skin = writer.addSkin("figure", firstJoint);
    const int body = writer.addNode({{"name", "skin"}, {"mesh", mesh}, {"skin", skin}});
    writer.document()["scenes"][0]["nodes"].push_back(root);
    writer.document()["scenes"][0]["nodes"].push_back(body);
    writer.animateFigure(writer.addAnimation("walk"), makeWalk(), firstJoint);
    std::printf("%-12s %6zu triangles\n", "skin", figure.skin.triangleCount());

    const int straw = writer.addMaterial("straw", {0.66F, 0.5F, 0.27F}, 0.9F);
    addProp(writer, {{"name", "hat"}}, makeHat(), straw, firstJoint + kHead);
    const int wood = writer.addMaterial("staff", {0.27F, 0.16F, 0.09F}, 0.7F);
    const int brass = writer.addMaterial("brass", {0.72F, 0.52F, 0.2F}, 0.45F);
    const int hand = firstJoint + kHandR;
    addProp(writer, placedNode("staff", barTranslation(kStaffGripHeight), barRotation()),
            makeStaff(), wood, hand);
    addProp(writer, placedNode("staffRings", barTranslation(kStaffGripHeight), barRotation()),
            makeStaffRings(), brass, hand);
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

}  // namespace

void makeBuiltin(GltfWriter& writer) {
    writer.document()["scenes"][0]["name"] = "walk";
    addFloor(writer, kFloorHalf);
    addFigure(writer);
    addProps(writer);
    addCamera(writer, {1.95F, 2.15F, 4.15F}, {0.55F, 0.74F, -0.2F}, 0.698F);
    addLight(writer, {{-2.65F, 3.35F, 1.5F}, {0, 1.25F, 0}, 0.8, 120.0});
}

}  // namespace tools
