// SPDX-License-Identifier: MIT
// Occlusion masks of the built-in scene at 1280 x 720 by light samples a side and by how pairs are
// found (0 bins, 1 the paper's grid): light samples decided per second, and each stage.
#include "bench/support/technique_run.h"

namespace penumbra::bench {
namespace {

void raster4d(benchmark::State& state, const char* stage) {
    const int side = static_cast<int>(state.range(0));
    TechniqueRun run(builtinScene(), "raster4d",
                     {{"raster4d.method", state.range(1) ? "grid" : "bins"}}, side * side,
                     scene::Pattern::grid);
    for (auto _ : state) state.SetIterationTime(1e-3 * run.stages()[stage]);
    state.SetItemsProcessed(state.iterations() * side * side * run.tested());
    state.SetLabel(device().info().name);
}

void raster4d_masks(benchmark::State& state) {
    raster4d(state, "masks");
}
BENCHMARK(raster4d_masks)
    ->ArgNames({"side", "grid"})
    ->ArgsProduct({{8, 16, 32, 64}, {0, 1}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void raster4d_receivers(benchmark::State& state) {
    raster4d(state, "receivers");
}
BENCHMARK(raster4d_receivers)
    ->ArgNames({"side", "grid"})
    ->Args({32, 0})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void raster4d_triangles(benchmark::State& state) {
    raster4d(state, "triangles");
}
BENCHMARK(raster4d_triangles)
    ->ArgNames({"side", "grid"})
    ->Args({32, 0})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
