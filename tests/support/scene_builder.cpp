// SPDX-License-Identifier: MIT
#include "tests/support/scene_builder.h"

#include <cmath>

namespace penumbra::tests {

SceneBuilder::SceneBuilder() {
    scene::Material material;
    material.metallic = 0;
    material.baseColor = {0.8F, 0.8F, 0.8F, 1};
    scene_.materials.push_back(material);
}

int SceneBuilder::addMesh(const std::vector<glm::vec3>& positions,
                          const std::vector<std::uint32_t>& indices, const glm::dmat4& world,
                          bool casts, bool receives) {
    scene::Primitive p;
    // Flat normals: vertices are unshared
    for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
        const glm::vec3 v[3] = {positions[indices[t]], positions[indices[t + 1]],
                                positions[indices[t + 2]]};
        const glm::vec3 cross = glm::cross(v[1] - v[0], v[2] - v[0]);
        const glm::vec3 normal =
            glm::length(cross) > 0 ? glm::normalize(cross) : glm::vec3(0, 1, 0);
        for (const auto& position : v) {
            p.indices.push_back(static_cast<std::uint32_t>(p.positions.size()));
            p.positions.push_back(position);
            p.normals.push_back(normal);
        }
    }
    scene::Node node;
    node.mesh = static_cast<int>(scene_.meshes.size());
    node.usesMatrix = true;
    node.matrix = world;
    node.castShadow = casts;
    node.receiveShadow = receives;
    scene_.meshes.push_back({"mesh", {p}, {}});
    scene_.order.push_back(static_cast<int>(scene_.nodes.size()));
    scene_.nodes.push_back(node);
    return static_cast<int>(scene_.nodes.size()) - 1;
}

int SceneBuilder::addQuad(glm::vec3 corner, glm::vec3 a, glm::vec3 b, bool casts, bool receives) {
    return addMesh({corner, corner + a, corner + a + b, corner + b}, {0, 1, 2, 0, 2, 3},
                   glm::dmat4(1), casts, receives);
}

int SceneBuilder::addSphere(glm::vec3 centre, float radius, int rings, int segments) {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
    const auto at = [&](int ring, int segment) {
        const double polar = M_PI * ring / rings,
                     angle = 2 * M_PI * (segment % segments) / segments;
        return centre + radius * glm::vec3(std::sin(polar) * std::cos(angle), std::cos(polar),
                                           -std::sin(polar) * std::sin(angle));
    };
    const auto addTriangle = [&](glm::vec3 a, glm::vec3 b, glm::vec3 c) {
        for (const auto& v : {a, b, c}) {
            indices.push_back(static_cast<std::uint32_t>(positions.size()));
            positions.push_back(v);
        }
    };
    const glm::vec3 top = centre + glm::vec3(0, radius, 0),
                    bottom = centre - glm::vec3(0, radius, 0);
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < segments; ++s) {
            const auto a = r == 0 ? top : at(r, s), b = r + 1 == rings ? bottom : at(r + 1, s);
            const auto c = r + 1 == rings ? bottom : at(r + 1, s + 1),
                       d = r == 0 ? top : at(r, s + 1);
            if (r + 1 != rings) addTriangle(a, b, c);
            if (r != 0) addTriangle(a, c, d);
        }
    return addMesh(positions, indices);
}

int SceneBuilder::addBox(glm::vec3 low, glm::vec3 high) {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                             i & 4 ? high.z : low.z);
    return addMesh(corners, {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                             2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5});
}

}  // namespace penumbra::tests
