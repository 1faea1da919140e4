// SPDX-License-Identifier: MIT
#include "tests/support/textured_scene.h"

#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using Random = std::mt19937;

float within(Random& random, float low, float high) {
    return std::uniform_real_distribution<float>(low, high)(random);
}

scene::Image randomImage(Random& random, int width, int height) {
    scene::Image image;
    image.width = width;
    image.height = height;
    for (int i = 0; i < 4 * width * height; ++i)
        image.texels.push_back(static_cast<std::uint8_t>(random() & 255U));
    return image;
}

/// Material of a surface; texture 0 is 7 x 5 texels, texture 1 is 4 x 8.
scene::Material materialOf(Surface surface) {
    scene::Material m;
    m.doubleSided = true;
    m.baseColor = {0.9F, 0.6F, 0.3F, 0.95F};
    if (surface == Surface::maskNearest || surface == Surface::maskSmooth) {
        m.alphaMode = scene::AlphaMode::mask;
        m.alphaCutoff = 0.45F;
        m.baseColorTexture.image = surface == Surface::maskNearest ? 0 : 1;
        m.baseColorTexture.nearest = surface == Surface::maskNearest;
        m.baseColorTexture.wrapU = scene::Wrap::mirror;
    }
    if (surface == Surface::maskSmooth) {
        m.baseColorTexture.uvSet = 1;
        m.baseColorTexture.wrapU = scene::Wrap::repeat;
        m.baseColorTexture.wrapV = scene::Wrap::clamp;
        m.baseColorTexture.uvFromUv = glm::mat3x2(0.8F, 0.3F, -0.4F, 0.9F, 0.15F, -0.35F);
    }
    if (surface == Surface::blend || surface == Surface::blendTexture)
        m.alphaMode = scene::AlphaMode::blend;
    if (surface == Surface::blend) m.baseColor.w = 0.3F;
    if (surface == Surface::blendTexture) m.baseColorTexture.image = 0;
    if (surface == Surface::transmission) m.alphaMode = scene::AlphaMode::blend;
    if (surface == Surface::transmission || surface == Surface::glass) m.transmission = 0.7F;
    return m;
}

scene::Primitive randomPrimitive(Random& random, int triangles) {
    scene::Primitive p;
    for (int t = 0; t < triangles; ++t) {
        const glm::vec3 centre(within(random, -1.2F, 1.2F), within(random, 0.8F, 2.2F),
                               within(random, -1.2F, 1.2F));
        for (int c = 0; c < 3; ++c) {
            p.indices.push_back(static_cast<std::uint32_t>(p.positions.size()));
            p.positions.push_back(centre + glm::vec3(within(random, -0.6F, 0.6F),
                                                     within(random, -0.4F, 0.4F),
                                                     within(random, -0.6F, 0.6F)));
            p.normals.emplace_back(0, 1, 0);
            for (auto& uvs : p.uvs) uvs.emplace_back(within(random, -2, 2), within(random, -2, 2));
            glm::vec4 colour;
            for (int k = 0; k < 4; ++k)
                colour[k] = static_cast<float>(128 + random() % 128) / 255.0F;
            p.colors.push_back(colour);
        }
    }
    return p;
}

}  // namespace

scene::Scene texturedScene(unsigned seed, int triangles, const std::vector<Surface>& surfaces) {
    Random random(seed);
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
    auto& scene = builder.scene();
    scene.images = {randomImage(random, 7, 5), randomImage(random, 4, 8)};
    for (const auto surface :
         {Surface::opaque, Surface::maskNearest, Surface::maskSmooth, Surface::blend,
          Surface::blendTexture, Surface::transmission, Surface::glass})
        scene.materials.push_back(materialOf(surface));
    for (const auto surface : surfaces) {
        auto p = randomPrimitive(random, triangles);
        p.material = 1 + static_cast<int>(surface);
        scene::Node node;
        node.mesh = static_cast<int>(scene.meshes.size());
        node.usesMatrix = true;
        const double mirror = scene.nodes.size() % 2 ? 1 : -1;
        node.matrix = glm::scale(glm::rotate(glm::dmat4(1), 0.4 * node.mesh, glm::dvec3(0, 1, 0)),
                                 glm::dvec3(mirror, 1, 1));
        scene.meshes.push_back({"soup", {p}, {}});
        scene.order.push_back(static_cast<int>(scene.nodes.size()));
        scene.nodes.push_back(node);
    }
    return scene;
}

}  // namespace penumbra::tests
