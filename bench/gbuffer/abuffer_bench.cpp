// SPDX-License-Identifier: MIT
// Lists of blended fragments: count, scan, fill, sort; and what the whole G-buffer costs with them.
#include "bench/support/bench.h"
#include "bench/support/triangle_grid.h"
#include "host/gbuffer/gbuffer.h"

namespace penumbra::bench {
namespace {

/// A screen full of blended triangles of 16 pixels, `layers` deep; alpha of the material, or of a
/// texture whose texels of alpha 0 are nothing, so that it is read for each fragment.
scene::Scene blendedGrid(int layers, bool textured) {
    auto scene = triangleGrid(16, layers);
    auto& m = scene.materials[0];
    m.alphaMode = scene::AlphaMode::blend;
    m.baseColor.w = 0.3F;
    if (!textured) return scene;
    scene::Image image{1024, 1024, {}};
    for (std::uint32_t i = 0; i < 1024 * 1024 * 4; ++i)
        image.texels.push_back(static_cast<std::uint8_t>(i * 2654435761U >> 24));
    scene.images.push_back(image);
    m.baseColorTexture.image = 0;
    return scene;
}

void measureGrid(benchmark::State& state, const std::string& stage) {
    const auto scene = blendedGrid(static_cast<int>(state.range(0)), state.range(1) != 0);
    geometry::Geometry geometry(program("frame"), scene, {0, 0, 0});
    const auto& mesh = geometry.run(scene::poseAt(scene, {}, 0));
    gbuffer::GBufferPass pass(program("frame"), kGridPixels, kGridPixels);
    const auto work = [&] { pass.run(mesh, gridCamera(), {0, 0, 0}); };
    do work();
    while (pass.grew());
    measureStage(state, stage, work);
    state.SetItemsProcessed(state.iterations() * pass.fragmentCounts().fragments);
}

/// Fragments per second of the lists alone, farthest layers last.
void abuffer(benchmark::State& state) {
    measureGrid(state, "fragments");
}
BENCHMARK(abuffer)
    ->ArgNames({"layers", "textured"})
    ->ArgsProduct({{1, 4, 16}, {0, 1}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// Fragments per second of their attributes; those of the empty image behind them included.
void abuffer_resolve(benchmark::State& state) {
    measureGrid(state, "resolve");
}
BENCHMARK(abuffer_resolve)
    ->ArgNames({"layers", "textured"})
    ->ArgsProduct({{1, 4}, {0, 1}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
