// SPDX-License-Identifier: MIT
// Merging of lists, pyramid and stack.
#include "bench/visibility/mlsm_bench.h"

namespace penumbra::bench {
namespace {

/// Milliseconds of all levels above the base; fragments of all levels per second.
void mlsm_filter(benchmark::State& state) {
    TechniqueRun run(sceneOf(state.range(0)), "mlsm",
                     settingsOf(state.range(1), {{"mlsm.stackFrom", std::to_string(state.range(2))},
                                                 {"mlsm.epsilon", std::to_string(state.range(3))}}),
                     1);
    for (auto _ : state) state.SetIterationTime(1e-3 * run.stages()["filtering"]);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(run.counts().points));
    state.counters["fragments"] = static_cast<double>(run.counts().points);
    state.SetLabel(device().info().name);
}
BENCHMARK(mlsm_filter)
    ->ArgNames({"walls", "resolution", "stackFrom", "epsilon"})
    ->ArgsProduct({{0, 1}, {512, 1024, 2048}, {128}, {2}})
    ->ArgsProduct({{0}, {1024}, {0, 128}, {1, 2, 10}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
