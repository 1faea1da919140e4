// SPDX-License-Identifier: MIT
// The rasteriser with 64-bit atomics (one pass), by triangle size; its own stage alone.
#include "bench/support/bench.h"
#include "bench/support/triangle_grid.h"
#include "host/gbuffer/gbuffer.h"

namespace penumbra::bench {
namespace {

/// Triangles per second by the length of their legs in pixels; four layers, front to back.
void gbuffer_raster64(benchmark::State& state) {
    const auto scene = triangleGrid(static_cast<int>(state.range(0)), 4);
    geometry::Geometry geometry(program("frame"), scene, {0, 0, 0});
    const auto& mesh = geometry.run(scene::poseAt(scene, {}, 0));
    gbuffer::GBufferPass pass(program("frame"), kGridPixels, kGridPixels);
    if (!pass.usesAtomics64()) {
        state.SkipWithError("the device has no 64-bit atomics");
        return;
    }
    const auto work = [&] { pass.run(mesh, gridCamera(), {0, 0, 0}); };
    do work();
    while (pass.grew());
    measureStage(state, "raster", work);
    state.SetItemsProcessed(state.iterations() * mesh.triangleCount);
}
BENCHMARK(gbuffer_raster64)
    ->ArgName("pixels")
    ->ArgsProduct({{2, 4, 8, 16, 64, 1024}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
