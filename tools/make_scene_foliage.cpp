// SPDX-License-Identifier: MIT
#include "make_scene_foliage.h"

#include <cmath>
#include <stdexcept>

#include "make_scene_random.h"

namespace tools {

using glm::vec2;
using glm::vec3;

namespace {

constexpr float kPi = 3.14159265F;

vec3 nextDirection(Jitter& jitter) {
    const float z = jitter.next();
    const float angle = kPi * jitter.next();
    const float r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), z, r * std::sin(angle)};
}

template <typename Place>
Mesh makeGrid(uint32_t columns, uint32_t rows, const Place& place) {
    Mesh mesh;
    for (uint32_t row = 0; row <= rows; ++row)
        for (uint32_t column = 0; column <= columns; ++column)
            mesh.positions.push_back(place(static_cast<float>(column) / static_cast<float>(columns),
                                           static_cast<float>(row) / static_cast<float>(rows)));
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            const uint32_t at = row * (columns + 1) + column;
            const uint32_t below = at + columns + 1;
            for (const uint32_t index : {at, below, below + 1, at, below + 1, at + 1})
                mesh.indices.push_back(index);
        }
    return mesh;
}

}  // namespace

Mesh makeCurtain(float halfWidth, float height, uint32_t columns, uint32_t rows) {
    return withNormals(makeGrid(columns, rows,
                                [&](float u, float v) {
                                    const float depth = 0.05F * (0.5F + 0.5F * v);
                                    return vec3(halfWidth * (2 * u - 1), height * (1 - v),
                                                depth * std::sin(2 * kPi * (7 * u + 0.25F * v)));
                                }),
                       80);
}

Mesh makeSheet(float width, float height, std::size_t triangleCount) {
    const auto rows = static_cast<uint32_t>(std::sqrt(static_cast<double>(triangleCount) / 2));
    const auto columns = static_cast<uint32_t>((triangleCount / 2 + rows - 1) / rows);
    Mesh mesh = makeGrid(columns, rows, [&](float u, float v) {
        return vec3(width * (u - 0.5F), -height * v, 0.06F * v * std::sin(9 * u + 2 * v));
    });
    if (triangleCount > mesh.triangleCount()) throw std::logic_error("a sheet is too small");
    mesh.indices.resize(3 * triangleCount);  // the last row ends where the number is reached
    return withNormals(mesh, 80);
}

Mesh makeTexturedQuad(const vec3& corner, const vec3& a, const vec3& b, const vec2& repeats) {
    Mesh mesh;
    const vec3 normal = glm::normalize(glm::cross(a, b));
    for (const vec2& at : {vec2(0, 0), vec2(1, 0), vec2(1, 1), vec2(0, 1)}) {
        mesh.positions.push_back(corner + at.x * a + at.y * b);
        mesh.normals.push_back(normal);
        mesh.uvs.emplace_back(at.x * repeats.x, (1 - at.y) * repeats.y);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

void appendWhole(Mesh& mesh, const Mesh& part) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), part.positions.begin(), part.positions.end());
    mesh.normals.insert(mesh.normals.end(), part.normals.begin(), part.normals.end());
    mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
    for (const uint32_t index : part.indices) mesh.indices.push_back(base + index);
}

int addMaskedMaterial(GltfWriter& writer, std::string_view name, const Picture& picture) {
    const int texture = writer.addTexture(picture, true);
    const int material = writer.addMaterial(name, {1, 1, 1}, 0.9F);
    nlohmann::json& m = writer.document()["materials"][material];
    m["pbrMetallicRoughness"]["baseColorTexture"]["index"] = texture;
    m["alphaMode"] = "MASK";
    m["alphaCutoff"] = 0.5;
    m["doubleSided"] = true;
    return material;
}

Picture leafPicture() {
    Picture picture(64, 128);
    for (uint32_t row = 0; row < picture.height; ++row)
        for (uint32_t column = 0; column < picture.width; ++column) {
            const float x = (static_cast<float>(column) + 0.5F) / 32 - 1;
            const float y = 1 - (static_cast<float>(row) + 0.5F) / 128;  // from the stalk on
            const float blade = std::min(std::max((y - 0.16F) / 0.8F, 0.0F), 1.0F);
            const float outline = 2.2F * std::sqrt(blade) * (1 - blade) * (1 + 0.5F * blade);
            const float edge =
                std::max(outline - std::abs(x), 0.06F * (y < 0.2F ? 1.0F : 0.0F) - std::abs(x));
            const bool vein = std::abs(x) < 0.05F ||
                              std::abs(std::fmod(y * 9 + std::abs(x) * 3, 1.0F) - 0.5F) < 0.06F;
            const float alpha = std::min(std::max(edge * 32 + 0.5F, 0.0F), 1.0F);
            picture.at(column, row) = {static_cast<uint8_t>(vein ? 120 : 84),
                                       static_cast<uint8_t>(vein ? 150 : 128), 60,
                                       static_cast<uint8_t>(255 * alpha)};
        }
    return picture;
}

Picture wirePicture() {
    Picture picture(64, 64);
    for (uint32_t row = 0; row < 64; ++row)
        for (uint32_t column = 0; column < 64; ++column) {
            // Two diagonals: distances to the nearest lines x + y and x - y, in texels
            const float sum = std::fmod(static_cast<float>(column + row) + 1, 64.0F);
            const float difference = std::fmod(static_cast<float>(column + 64 - row), 64.0F);
            const float nearest =
                std::min(std::min(sum, 64 - sum), std::min(difference, 64 - difference));
            const float alpha = std::min(std::max((7 - nearest) * 0.5F, 0.0F), 1.0F);
            picture.at(column, row) = {170, 172, 176, static_cast<uint8_t>(255 * alpha)};
        }
    return picture;
}

namespace {

void addBranch(TreeParts& tree, std::vector<vec3>& tips, Jitter& jitter, const vec3& from,
               const vec3& along, float length, float radius, int depth) {
    std::vector<SweepRing> rings;
    vec3 at = from;
    vec3 heading = along;
    constexpr int kStations = 6;
    for (int i = 0; i <= kStations; ++i) {
        const float t = static_cast<float>(i) / kStations;
        rings.push_back({at, radius * (1 - 0.45F * t), radius * (1 - 0.45F * t)});
        heading = glm::normalize(heading + 0.16F * nextDirection(jitter) + vec3(0, 0.03F, 0));
        at += heading * (length / kStations);
        if (depth >= 2) tips.push_back(at);
    }
    append(tree.wood, makeSweep(rings, glm::normalize(glm::cross(along, vec3(0.3F, 0.1F, 1))), 10));
    if (depth == 4) return;
    const int branches = depth == 0 ? 5 : 3;
    for (int i = 0; i < branches; ++i) {
        const vec3 side =
            glm::normalize(heading + 0.95F * nextDirection(jitter) + vec3(0, 0.25F, 0));
        const float back = 0.35F * static_cast<float>(i) / static_cast<float>(branches);
        addBranch(tree, tips, jitter, at - heading * (length * back), side, length * 0.7F,
                  radius * 0.55F, depth + 1);
    }
}

}  // namespace

TreeParts makeTreeParts(int leafCount) {
    TreeParts tree;
    std::vector<vec3> tips;
    Jitter jitter;
    addBranch(tree, tips, jitter, {0, -0.02F, 0}, {0, 1, 0}, 0.95F, 0.11F, 0);
    for (int i = 0; i < leafCount; ++i) {
        const vec3 foot = tips[static_cast<std::size_t>(i) * 7919 % tips.size()];
        const vec3 up = glm::normalize(nextDirection(jitter) + vec3(0, -0.2F, 0));
        const vec3 side = glm::normalize(glm::cross(up, nextDirection(jitter)));
        const float size = 0.15F + 0.03F * jitter.next();
        appendWhole(tree.leaves, makeTexturedQuad(foot - side * (size * 0.25F),
                                                  side * (size * 0.5F), up * size, {1, 1}));
    }
    return tree;
}

}  // namespace tools
