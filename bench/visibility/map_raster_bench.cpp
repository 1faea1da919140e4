// SPDX-License-Identifier: MIT
// Triangles to depth maps of 1024^2: (triangles x maps) per second by form, number of maps and
// texel; and the depth maps of mvr beside those of vwss, where either wins.
#include "bench/support/technique_run.h"

namespace penumbra::bench {
namespace {

/// Built-in scene; all triangles count, also those that a form leaves out.
void map_raster(benchmark::State& state) {
    TechniqueRun run(builtinScene(), "mvr",
                     {{"mvr.form", state.range(0) ? "textbook" : "full"},
                      {"mvr.depthBits", std::to_string(state.range(2))}},
                     static_cast<int>(state.range(1)));
    for (auto _ : state) state.SetIterationTime(1e-3 * run.stages()["depth maps"]);
    state.SetItemsProcessed(state.iterations() * state.range(1) *
                            static_cast<std::int64_t>(builtinScene().mesh().casterTriangleCount));
    state.counters["drawn"] = static_cast<double>(run.counts().mapTriangles);
    state.SetLabel(device().info().name);
}
BENCHMARK(map_raster)
    ->ArgNames({"form", "maps", "bits"})  // 0 full, 1 textbook
    ->ArgsProduct({{0, 1}, {1, 24, 128}, {16, 32}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// Depth maps of 24 samples by both techniques: the built-in scene (many small triangles), and a
/// dozen quads as large as the view (26 triangles that make millions of points). Times those of
/// mvr.
void map_raster_or_points(benchmark::State& state) {
    auto& scene = state.range(0) ? wallScene() : builtinScene();
    TechniqueRun mvr(scene, "mvr", {}, 24), vwss(scene, "vwss", {}, 24);
    double mvrMs = 0, vwssMs = 0;
    for (auto _ : state) {
        const double ms = mvr.stages()["depth maps"];
        state.SetIterationTime(1e-3 * ms);
        mvrMs += ms;
        auto stages = vwss.stages();
        vwssMs += stages["points"] + stages["depth maps"];
    }
    const auto runs = static_cast<double>(state.iterations());
    state.counters["mvr_ms"] = mvrMs / runs;
    state.counters["vwss_ms"] = vwssMs / runs;
    state.counters["triangles"] = static_cast<double>(mvr.counts().mapTriangles);
    state.counters["points"] = static_cast<double>(vwss.counts().points);
    state.SetLabel(device().info().name);
}
BENCHMARK(map_raster_or_points)
    ->ArgName("walls")
    ->Arg(0)
    ->Arg(1)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
