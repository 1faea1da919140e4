// SPDX-License-Identifier: MIT
// Lighting by pcss of the built-in scene at 1280 x 720: taps per second, by taps of the search and
// of the filter.
#include "bench/support/technique_run.h"

namespace penumbra::bench {
namespace {

void pcss(benchmark::State& state) {
    TechniqueRun run(builtinScene(), "pcss",
                     {{"pcss.blockerTaps", std::to_string(state.range(0))},
                      {"pcss.filterTaps", std::to_string(state.range(1))},
                      {"pcss.rotate", state.range(2) ? "true" : "false"}},
                     1);
    for (auto _ : state) state.SetIterationTime(1e-3 * run.stages()["lighting"]);
    state.SetItemsProcessed(state.iterations() * run.tested() * (state.range(0) + state.range(1)));
    state.SetLabel(device().info().name);
}
BENCHMARK(pcss)
    ->ArgNames({"search", "filter", "rotate"})
    ->Args({16, 24, 1})
    ->Args({64, 96, 0})
    ->Args({64, 96, 1})  // [VWSS] 4
    ->Args({128, 192, 1})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
