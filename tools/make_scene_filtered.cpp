// SPDX-License-Identifier: MIT
// The scenes of [MLSM]: occluders at many depths over one another, leaves and wire as alpha
// textures, coloured glass.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "make_scene_foliage.h"
#include "make_scene_scenes.h"
#include "make_scene_stage.h"

namespace tools {

using glm::quat;
using glm::vec2;
using glm::vec3;

namespace {

constexpr float kPi = 3.14159265F;

void addBox(Mesh& mesh, const vec3& centre, const vec3& half) {
    append(mesh, makeBox(centre, half));
}

Mesh makeColumn(float height) {
    return makeLathe({{0.34F, 0},
                      {0.34F, 0.12F},
                      {0.26F, 0.2F},
                      {0.24F, 0.3F},
                      {0.23F, height * 0.5F},
                      {0.2F, height - 0.35F},
                      {0.2F, height - 0.3F},
                      {0.3F, height - 0.12F},
                      {0.3F, height}},
                     96);
}

// A lantern on a rod: a cage of bars between two caps.
Mesh makeLantern(float rod) {
    Mesh mesh = makeBar({0, 0.4F, 0}, {0, 0.4F + rod, 0}, 0.008F, 12);
    append(mesh, makeLathe({{0.12F, 0}, {0.14F, 0.02F}, {0.12F, 0.04F}}, 48));
    append(mesh, makeLathe({{0.15F, 0.36F}, {0.1F, 0.4F}, {0.02F, 0.44F}}, 48));
    for (int i = 0; i < 10; ++i) {
        const float angle = 2 * kPi * static_cast<float>(i) / 10;
        const vec3 side(0.115F * std::cos(angle), 0, 0.115F * std::sin(angle));
        append(mesh, makeBar(side, side + vec3(0, 0.37F, 0), 0.006F, 8));
    }
    append(mesh, makeSphere(0.05F, 32, 16), quat(1, 0, 0, 0), {0, 0.18F, 0});
    return mesh;
}

void addColonnade(GltfWriter& writer) {
    constexpr float kHeight = 2.6F;
    const int stone = writer.addMaterial("stone", {0.62F, 0.57F, 0.48F}, 0.9F);
    const Mesh column = withNormals(makeColumn(kHeight), 50);
    const int columnMesh = writer.addMesh("column", column, stone);
    for (const float z : {-0.9F, 0.9F})
        for (int i = 0; i < 4; ++i) {
            nlohmann::json node =
                placedNode("column", {-2.4F + 1.6F * static_cast<float>(i), 0, z}, yaw(0));
            node["mesh"] = columnMesh;
            addUnder(writer, -1, node);
        }
    Mesh beams;
    for (const float z : {-0.9F, 0.9F})
        addBox(beams, {0, kHeight + 0.15F, z}, {2.9F, 0.15F, 0.28F});
    addProp(writer, {{"name", "beams"}}, withNormals(beams, 30), stone);
}

}  // namespace

void makeHall(GltfWriter& writer) {
    addFloor(writer, 9);
    addColonnade(writer);
    const int bronze = writer.addMaterial("bronze", {0.42F, 0.28F, 0.14F}, 0.5F);
    for (const float x : {-1.6F, 0.0F, 1.6F})
        addProp(writer, placedNode("lantern", {x, 1.5F, 0.9F}, yaw(20 * x)),
                withNormals(makeLantern(0.66F), 50), bronze);
    const vec3 cloths[] = {{0.5F, 0.08F, 0.06F}, {0.1F, 0.24F, 0.4F}, {0.12F, 0.32F, 0.14F}};
    for (int i = 0; i < 3; ++i) {
        const int cloth = writer.addMaterial("curtain", cloths[i], 0.95F);
        writer.document()["materials"][cloth]["doubleSided"] = true;
        addProp(writer,
                placedNode("curtain", {-1.6F + 1.6F * static_cast<float>(i), 0.7F, -0.9F}, yaw(0)),
                makeCurtain(0.55F + 0.1F * static_cast<float>(i), 1.85F, 160, 48), cloth);
    }
    addCamera(writer, {3.4F, 2.7F, 5.2F}, {0.2F, 0.75F, -0.4F}, 0.72F);
    addLight(writer, {{-2.2F, 5.4F, 4.2F}, {0, 1, -0.2F}, 0.7, 420});
}

namespace {

constexpr std::size_t kStreetTriangles = 400000;

// A house front: wall, tiled roof, balconies with bars, shutters.
Mesh makeHouse(float width, float height) {
    Mesh mesh;
    addBox(mesh, {0, height / 2, -1}, {width / 2, height / 2, 0.9F});
    for (int row = 0; row < 16; ++row)
        for (int i = 0; i < 24; ++i) {
            const float x = width * ((static_cast<float>(i) + 0.5F) / 24 - 0.5F);
            const float t = static_cast<float>(row) / 16;
            append(mesh, makeBar({x, height + 0.75F * t, 0.25F - 1.25F * t},
                                 {x, height + 0.75F * t + 0.06F, 0.12F - 1.25F * t}, 0.05F, 8));
        }
    for (int storey = 1; storey * 1.1F < height; ++storey) {
        const float y = static_cast<float>(storey) * 1.1F;
        addBox(mesh, {0, y, 0.15F}, {width * 0.4F, 0.03F, 0.25F});
        for (int i = 0; i < 28; ++i) {
            const float x = width * 0.8F * ((static_cast<float>(i) + 0.5F) / 28 - 0.5F);
            append(mesh, makeBar({x, y, 0.38F}, {x, y + 0.32F, 0.38F}, 0.008F, 6));
        }
        addBox(mesh, {0, y + 0.33F, 0.38F}, {width * 0.4F, 0.015F, 0.015F});
        for (const float side : {-0.22F, 0.22F})
            for (int slat = 0; slat < 14; ++slat)
                addBox(mesh, {side * width, y + 0.15F + 0.04F * static_cast<float>(slat), -0.08F},
                       {0.13F, 0.012F, 0.03F});
    }
    return mesh;
}

// Lines of lanterns from side to side.
Mesh makeGarlands() {
    Mesh mesh;
    for (int line = 0; line < 9; ++line) {
        const float z = -6 + 1.5F * static_cast<float>(line);
        for (int i = 0; i < 11; ++i) {
            const float t = static_cast<float>(i) / 10;
            const float sag = 4 * t * (1 - t);
            const vec3 place(-2.2F + 4.4F * t, 2.9F - 0.5F * sag, z);
            append(mesh, makeSphere(0.07F, 24, 12), quat(1, 0, 0, 0), place);
            append(mesh, makeBar(place, place + vec3(0.44F, i < 5 ? -0.1F : 0.1F, 0), 0.004F, 6));
        }
    }
    return mesh;
}

// Barrels, crates and market stalls on both sides.
Mesh makeStalls() {
    Mesh mesh;
    for (int i = 0; i < 12; ++i) {
        const float side = i % 2 == 0 ? -1.0F : 1.0F;
        const float z = -6.2F + 1.1F * static_cast<float>(i);
        const vec3 place(side * 1.45F, 0, z);
        addBox(mesh, place + vec3(0, 0.45F, 0), {0.35F, 0.02F, 0.4F});
        for (const float dx : {-0.32F, 0.32F})
            for (const float dz : {-0.36F, 0.36F})
                append(mesh,
                       makeBar(place + vec3(dx, 0, dz), place + vec3(dx, 1.1F, dz), 0.02F, 8));
        for (int fruit = 0; fruit < 40; ++fruit) {
            const vec3 at(-0.28F + 0.08F * static_cast<float>(fruit % 8), 0.51F,
                          -0.3F + 0.14F * static_cast<float>(fruit / 8));
            append(mesh, makeSphere(0.04F, 12, 8), quat(1, 0, 0, 0), place + at);
        }
        append(mesh, makeLathe({{0.16F, 0}, {0.21F, 0.2F}, {0.16F, 0.42F}}, 32), quat(1, 0, 0, 0),
               place - vec3(side * 0.55F, 0, 0.5F));
    }
    return mesh;
}

}  // namespace

void makeStreet(GltfWriter& writer) {
    addFloor(writer, 10);
    const int plaster = writer.addMaterial("plaster", {0.66F, 0.55F, 0.42F}, 0.95F);
    const int red = writer.addMaterial("lantern", {0.62F, 0.12F, 0.08F}, 0.8F);
    const int wood = writer.addMaterial("wood", {0.36F, 0.24F, 0.15F}, 0.9F);
    const int linen = writer.addMaterial("linen", {0.7F, 0.66F, 0.56F}, 0.95F);
    std::size_t triangles = 0;
    const auto add = [&](const std::string& name, const Mesh& mesh, const vec3& place, float turn,
                         int material) {
        addProp(writer, placedNode(name, place, yaw(turn)), mesh, material);
        triangles += mesh.triangleCount();
    };
    for (int i = 0; i < 10; ++i) {
        const bool left = i % 2 == 0;
        const float width = 2.2F + 0.2F * static_cast<float>(i % 3);
        const Mesh house =
            withNormals(makeHouse(width, 2.4F + 0.5F * static_cast<float>(i % 4)), 40);
        add("house", house, {left ? -2.3F : 2.3F, 0, -6 + 2.6F * static_cast<float>(i / 2)},
            left ? 90.0F : -90.0F, plaster);
    }
    add("garlands", withNormals(makeGarlands(), 50), vec3(0), 0, red);
    add("stalls", withNormals(makeStalls(), 50), vec3(0), 0, wood);
    // Washing across the street takes what is left, to the triangle
    const std::size_t rest = kStreetTriangles - triangles;
    writer.document()["materials"][linen]["doubleSided"] = true;
    for (std::size_t i = 0; i < 8; ++i) {
        const std::size_t share = rest / 8 + (i < rest % 8 ? 1 : 0);
        add("washing", makeSheet(0.9F, 0.7F, share),
            {-1.1F + 0.3F * static_cast<float>(i % 7), 1.7F + 0.25F * static_cast<float>(i % 3),
             -5.5F + 1.4F * static_cast<float>(i)},
            20 * static_cast<float>(i % 3), linen);
    }
    addCamera(writer, {0.5F, 2.2F, 7.4F}, {0, 1.1F, 0}, 0.8F);
    addLight(writer, {{-3.5F, 9, 4}, {0, 1, -0.8F}, 0.9, 900});
}

void makeFoliage(GltfWriter& writer) {
    addFloor(writer, 8);
    const int bark = writer.addMaterial("bark", {0.27F, 0.2F, 0.14F}, 0.95F);
    const int leaf = addMaskedMaterial(writer, "leaf", leafPicture());
    const TreeParts tree = makeTreeParts(2400);
    addProp(writer, {{"name", "trunk"}}, withNormals(tree.wood, 70), bark);
    addProp(writer, {{"name", "leaves"}}, tree.leaves, leaf);
    addCamera(writer, {2.9F, 2.6F, 5.4F}, {0.5F, 1.0F, 0}, 0.72F);
    addLight(writer, {{-3, 5.5F, 2.2F}, {0, 1.3F, 0}, 0.25, 2800});
}

void makeFence(GltfWriter& writer) {
    addFloor(writer, 8);
    const int wire = addMaskedMaterial(writer, "wire", wirePicture());
    const int steel = writer.addMaterial("steel", {0.5F, 0.51F, 0.52F}, 0.5F);
    const int wall = writer.addMaterial("wall", {0.6F, 0.58F, 0.55F}, 0.95F);
    // The fence stands on the ground before a wall: its shadow is sharp at its foot and soft afar
    Mesh posts;
    for (int i = 0; i < 5; ++i) {
        const float x = -2 + static_cast<float>(i);
        append(posts, makeBar({x, 0, 0}, {x, 1.5F, 0}, 0.03F, 24));
    }
    append(posts, makeBar({-2, 1.48F, 0}, {2, 1.48F, 0}, 0.02F, 24));
    addProp(writer, {{"name", "posts"}}, withNormals(posts, 50), steel);
    addProp(writer, {{"name", "wire"}},
            makeTexturedQuad({-2, 0.05F, 0}, {4, 0, 0}, {0, 1.4F, 0}, {40, 14}), wire);
    Mesh block;
    addBox(block, {0, 0.9F, -2.6F}, {2.6F, 0.9F, 0.1F});
    addProp(writer, {{"name", "wall"}}, withNormals(block, 30), wall);
    addCamera(writer, {1.6F, 1.8F, 4.4F}, {0.1F, 0.5F, -0.9F}, 0.7F);
    addLight(writer, {{-1.6F, 3.6F, 4.2F}, {0, 0.6F, -0.6F}, 0.35, 900});
}

namespace {

constexpr vec3 kPanes[] = {{0.85F, 0.08F, 0.06F}, {0.06F, 0.16F, 0.8F}, {0.95F, 0.7F, 0.08F},
                           {0.08F, 0.6F, 0.16F},  {0.55F, 0.1F, 0.6F},  {0.9F, 0.85F, 0.75F}};
constexpr int kRings = 4, kSpokes = 12;

vec3 onWindow(float ring, float spoke) {
    const float angle = 2 * kPi * spoke / kSpokes, radius = 0.22F * ring;
    return {radius * std::cos(angle), 1.3F + radius * std::sin(angle), 0};
}

// One pane of the rose window: a sector between two rings, flat.
Mesh makePane(int ring, int spoke) {
    constexpr int kSteps = 6;
    Mesh mesh;
    for (int i = 0; i <= kSteps; ++i) {
        const float at = static_cast<float>(spoke) + static_cast<float>(i) / kSteps;
        for (const int edge : {ring, ring + 1}) {
            mesh.positions.push_back(onWindow(static_cast<float>(edge), at));
            mesh.normals.emplace_back(0, 0, 1);
        }
    }
    for (uint32_t i = 0; i < kSteps; ++i)
        for (const uint32_t corner : {0U, 1U, 3U, 0U, 3U, 2U})
            mesh.indices.push_back(2 * i + corner);
    return mesh;
}

Mesh makeLead() {
    Mesh mesh;
    for (int ring = 1; ring <= kRings; ++ring)
        for (int i = 0; i < 6 * kSpokes; ++i)
            append(mesh, makeBar(onWindow(static_cast<float>(ring), static_cast<float>(i) / 6),
                                 onWindow(static_cast<float>(ring), static_cast<float>(i + 1) / 6),
                                 ring == kRings ? 0.03F : 0.012F, 8));
    for (int spoke = 0; spoke < kSpokes; ++spoke)
        append(mesh, makeBar(onWindow(0, static_cast<float>(spoke)),
                             onWindow(kRings, static_cast<float>(spoke)), 0.01F, 8));
    return mesh;
}

}  // namespace

void makeWindow(GltfWriter& writer) {
    addFloor(writer, 8);
    std::vector<Mesh> glass(std::size(kPanes));
    for (int ring = 0; ring < kRings; ++ring)
        for (int spoke = 0; spoke < kSpokes; ++spoke)
            appendWhole(
                glass[static_cast<std::size_t>(ring * 5 + spoke * (ring + 2)) % glass.size()],
                makePane(ring, spoke));
    for (std::size_t i = 0; i < glass.size(); ++i) {
        const int pane = writer.addMaterial("glass", kPanes[i], 0.3F);
        nlohmann::json& material = writer.document()["materials"][pane];
        material["doubleSided"] = true;
        material["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0.95;
        addProp(writer, {{"name", "glass"}}, glass[i], pane);
    }
    const int lead = writer.addMaterial("lead", {0.12F, 0.12F, 0.13F}, 0.7F);
    addProp(writer, {{"name", "lead"}}, withNormals(makeLead(), 50), lead);
    const int stone = writer.addMaterial("stone", {0.6F, 0.56F, 0.5F}, 0.95F);
    Mesh blocks;
    addBox(blocks, {-1.3F, 1.15F, 0}, {0.36F, 1.15F, 0.12F});
    addBox(blocks, {1.3F, 1.15F, 0}, {0.36F, 1.15F, 0.12F});
    addBox(blocks, {0, 0.19F, 0}, {0.94F, 0.19F, 0.12F});
    addBox(blocks, {0.25F, 0.2F, 1.5F}, {0.2F, 0.2F, 0.2F});
    addProp(writer, {{"name", "stone"}}, withNormals(blocks, 30), stone);
    addProp(writer, placedNode("ball", {-0.5F, 0.22F, 1.7F}, yaw(0)),
            withNormals(makeSphere(0.22F, 72, 36), 60), stone);
    addCamera(writer, {1.9F, 2.3F, 4.6F}, {0.1F, 0.55F, 0.9F}, 0.75F);
    addLight(writer, {{-0.8F, 4.4F, -3.6F}, {0, 1.1F, 0}, 0.4, 1400});
    writer.document()["extensionsUsed"].push_back("KHR_materials_transmission");
}

}  // namespace tools
