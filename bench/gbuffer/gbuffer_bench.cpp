// SPDX-License-Identifier: MIT
// The rasteriser by triangle size, and the G-buffer of the built-in scene.
#include "bench/support/bench.h"
#include "host/gbuffer/gbuffer.h"

namespace penumbra::bench {
namespace {

/// A grid of triangles whose legs are `pixels` long on a 1024 x 1024 screen, `layers` deep.
scene::Scene triangleGrid(int pixels, int layers) {
    scene::Scene scene;
    scene.materials.emplace_back();
    scene::Primitive p;
    const int cells = 1024 / pixels;
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

scene::CameraFrame frontCamera() {
    scene::CameraFrame camera;
    camera.worldFromCamera[3] = {0, 0, 2, 1};
    camera.yfovRad = 2 * std::atan(0.5);
    return camera;
}

/// Triangles per second by the length of their legs in pixels; four layers, back to front.
void gbuffer_raster(benchmark::State& state) {
    const auto pixels = static_cast<int>(state.range(0));
    const auto scene = triangleGrid(pixels, 4);
    const std::vector<int> still;
    geometry::Geometry geometry(program("frame"), scene, {0, 0, 0});
    const auto& mesh = geometry.run(scene::poseAt(scene, still, 0));
    gbuffer::GBufferPass pass(program("frame"), 1024, 1024, state.range(1) != 0);
    const auto work = [&] { pass.run(mesh, frontCamera(), {0, 0, 0}); };
    do work();
    while (pass.grew());
    measure(state, work);
    state.SetItemsProcessed(state.iterations() * mesh.triangleCount);
}
BENCHMARK(gbuffer_raster)
    ->ArgNames({"pixels", "atomics64"})
    ->ArgsProduct({{2, 4, 8, 16, 64, 1024}, {0, 1}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// The whole pass on the built-in scene: pixels per second.
void gbuffer(benchmark::State& state) {
    auto& posed = builtinScene();
    scene::CameraChoice choice;
    const auto pose = scene::poseAt(posed.scene, scene::chooseAnimations(posed.scene, ""), 0.25);
    const auto camera = scene::cameraAt(posed.scene, pose, choice, posed.bounds, 16.0 / 9);
    gbuffer::GBufferPass pass(program("frame"), 1280, 720);
    const auto work = [&] { pass.run(posed.mesh(), camera, posed.bounds.centre()); };
    do work();
    while (pass.grew());
    measure(state, work);
    state.SetItemsProcessed(state.iterations() * 1280 * 720);
}
BENCHMARK(gbuffer)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
