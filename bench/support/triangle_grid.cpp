// SPDX-License-Identifier: MIT
#include "bench/support/triangle_grid.h"

#include <cmath>

namespace penumbra::bench {

scene::Scene triangleGrid(int pixels, int layers) {
    scene::Scene scene;
    scene.materials.emplace_back();
    scene::Primitive p;
    const int cells = kGridPixels / pixels;
    for (int layer = 0; layer < layers; ++layer)
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x) {
                const float s = 2.0F / static_cast<float>(cells),
                            z = -0.01F * static_cast<float>(layer);
                const float x0 = -1 + s * static_cast<float>(x),
                            y0 = -1 + s * static_cast<float>(y);
                const auto base = static_cast<std::uint32_t>(p.positions.size());
                for (const glm::vec3 v : {glm::vec3(x0, y0, z), glm::vec3(x0 + s, y0, z),
                                          glm::vec3(x0 + s, y0 + s, z), glm::vec3(x0, y0 + s, z)}) {
                    p.positions.push_back(v);
                    p.normals.emplace_back(0, 0, 1);
                    p.uvs[0].emplace_back(0.5F + 0.5F * v.x, 0.5F - 0.5F * v.y);
                }
                for (const std::uint32_t i : {0U, 1U, 2U, 0U, 2U, 3U})
                    p.indices.push_back(base + i);
            }
    scene.meshes.push_back({"grid", {p}, {}});
    scene::Node node;
    node.mesh = 0;
    scene.nodes.push_back(node);
    scene.order = {0};
    return scene;
}

scene::CameraFrame gridCamera() {
    scene::CameraFrame camera;
    camera.worldFromCamera[3] = {0, 0, 2, 1};
    camera.yfovRad = 2 * std::atan(0.5);
    return camera;
}

}  // namespace penumbra::bench
