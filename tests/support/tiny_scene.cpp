// SPDX-License-Identifier: MIT
#include "tests/support/tiny_scene.h"

#include "host/scene/camera.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {

scene::Scene tinyScene() {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
    const int box = builder.addBox({-0.5F, 0.2F, -0.5F}, {0.5F, 0.8F, 0.5F});
    const int leaf = builder.addQuad({-1, 1, 0.5F}, {0.7F, 0, 0}, {0, 0, -0.7F});
    const int glass = builder.addQuad({0.4F, 1, 0.5F}, {0.7F, 0, 0}, {0, 0.1F, -0.7F});
    auto& scene = builder.scene();
    scene::Image checker;
    checker.width = checker.height = 4;
    for (int i = 0; i < 16; ++i)
        for (int c = 0; c < 4; ++c)
            checker.texels.push_back(static_cast<std::uint8_t>((i + i / 4) % 2 ? 255 : 100));
    scene.images.push_back(checker);
    for (int kind = 1; kind <= 3; ++kind) {
        auto material = scene.materials[0];
        material.baseColorTexture.image = 0;
        if (kind == 1) material.alphaMode = scene::AlphaMode::mask;
        if (kind == 2) material.alphaMode = scene::AlphaMode::blend;
        if (kind == 3) material.normalTexture.image = material.metallicRoughnessTexture.image = 0;
        scene.materials.push_back(material);
    }
    const std::pair<int, int> uses[] = {{leaf, 1}, {glass, 2}, {box, 3}};
    for (const auto& [node, material] : uses) {
        auto& p =
            scene.meshes[static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].mesh)]
                .primitives[0];
        p.material = material;
        for (const auto& position : p.positions)
            p.uvs[0].emplace_back(position.x * 3, position.z * 3 + position.y);
    }
    scene::Light light;
    light.name = "key";
    light.width = light.height = 0.5;
    light.worldFromLight = scene::lookAt({1, 4, 1}, {0, 0.5, 0}, {0, 1, 0});
    scene.lights.push_back(light);
    return scene;
}

RenderOptions tinyOptions() {
    RenderOptions options;
    options.width = 20;
    options.height = 12;
    options.lightSamples = "3";
    options.eye = {{2.5, 2.5, 3.5}};
    options.target = {{0, 0.5, 0}};
    return options;
}

}  // namespace penumbra::tests
