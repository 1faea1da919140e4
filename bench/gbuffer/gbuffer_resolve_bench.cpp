// SPDX-License-Identifier: MIT
// Surface attributes of the nearest triangles; the stage alone.
#include "bench/support/bench.h"
#include "bench/support/triangle_grid.h"
#include "host/gbuffer/gbuffer.h"

namespace penumbra::bench {
namespace {

/// Bytes that a pixel costs at the least: its planes and its word of the visibility buffer.
constexpr std::int64_t kBytesPerPixel = (GB_PLANES + 1) * 4;

void report(benchmark::State& state, const gbuffer::GBuffer& gbuffer) {
    const auto pixels = static_cast<std::int64_t>(gbuffer.width) * gbuffer.height;
    state.SetItemsProcessed(state.iterations() * pixels);
    state.SetBytesProcessed(state.iterations() * pixels * kBytesPerPixel);
}

/// The built-in scene at 1280 x 720: pixels and bytes per second.
void gbuffer_resolve(benchmark::State& state) {
    auto& posed = builtinScene();
    const auto pose = scene::poseAt(posed.scene, scene::chooseAnimations(posed.scene, ""), 0.25);
    const auto camera = scene::cameraAt(posed.scene, pose, {}, posed.bounds, 16.0 / 9);
    gbuffer::GBufferPass pass(program("frame"), 1280, 720);
    const auto work = [&] { pass.run(posed.mesh(), camera, posed.bounds.centre()); };
    do work();
    while (pass.grew());
    measureStage(state, "resolve", work);
    report(state, pass.result());
}
BENCHMARK(gbuffer_resolve)->UseManualTime()->Unit(benchmark::kMillisecond);

/// A screen of triangles of 16 pixels with `textures` of four textures of 1024^2 texels.
void gbuffer_resolve_textured(benchmark::State& state) {
    auto scene = triangleGrid(16, 1);
    scene::Image image{1024, 1024, {}};
    for (std::uint32_t i = 0; i < 1024 * 1024 * 4; ++i)
        image.texels.push_back(static_cast<std::uint8_t>(i * 2654435761U >> 24));
    scene.images.push_back(image);
    auto& m = scene.materials[0];
    scene::TextureRef* const uses[] = {&m.baseColorTexture, &m.metallicRoughnessTexture,
                                       &m.emissiveTexture, &m.normalTexture};
    for (std::int64_t i = 0; i < state.range(0); ++i) uses[i]->image = 0;
    geometry::Geometry geometry(program("frame"), scene, {0, 0, 0});
    const auto& mesh = geometry.run(scene::poseAt(scene, {}, 0));
    gbuffer::GBufferPass pass(program("frame"), kGridPixels, kGridPixels);
    const auto work = [&] { pass.run(mesh, gridCamera(), {0, 0, 0}); };
    do work();
    while (pass.grew());
    measureStage(state, "resolve", work);
    report(state, pass.result());
}
BENCHMARK(gbuffer_resolve_textured)
    ->ArgName("textures")
    ->Arg(0)
    ->Arg(1)
    ->Arg(4)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
