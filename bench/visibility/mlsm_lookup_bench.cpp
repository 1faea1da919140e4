// SPDX-License-Identifier: MIT
// Lookup of 1280 x 720 receivers.
#include "bench/visibility/mlsm_bench.h"

namespace penumbra::bench {
namespace {

/// Milliseconds of lighting; receivers per second.
void lookup(benchmark::State& state, const SettingValues& settings) {
    TechniqueRun run(sceneOf(state.range(0)), "mlsm", settingsOf(state.range(1), settings), 1);
    for (auto _ : state) state.SetIterationTime(1e-3 * run.stages()["lighting"]);
    state.SetItemsProcessed(state.iterations() * run.tested());
    state.SetLabel(device().info().name);
}
const auto kLookupArgs = [](benchmark::internal::Benchmark* b) {
    b->ArgNames({"walls", "resolution"})
        ->ArgsProduct({{0, 1}, {512, 1024, 2048}})
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond);
};
BENCHMARK_CAPTURE(lookup, mlsm_add, {{"mlsm.accumulateLookup", "add"}})->Apply(kLookupArgs);
BENCHMARK_CAPTURE(lookup, mlsm_multiply, {{"mlsm.accumulateLookup", "multiply"}})
    ->Apply(kLookupArgs);
BENCHMARK_CAPTURE(lookup, mlsm_half, {{"mlsm.halfResolution", "true"}})->Apply(kLookupArgs);

}  // namespace
}  // namespace penumbra::bench
