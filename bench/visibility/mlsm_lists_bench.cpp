// SPDX-License-Identifier: MIT
// Lists of the base level, array and linked list.
#include "bench/visibility/mlsm_bench.h"

namespace penumbra::bench {
namespace {

/// Milliseconds of counting, scan, collecting and sorting; fragments per second.
void mlsm_lists(benchmark::State& state) {
    TechniqueRun run(sceneOf(state.range(0)), "mlsm",
                     settingsOf(state.range(1), {{"mlsm.build", state.range(2) ? "list" : "array"},
                                                 {"mlsm.maxLevel", "0"}}),
                     1);
    std::map<std::string, double> sums;
    for (auto _ : state) {
        double ms = 0;
        for (const auto& [name, stage] : run.stages())
            if (name.starts_with("fragment ")) {
                ms += stage;
                sums[name] += stage;
            }
        state.SetIterationTime(1e-3 * ms);
    }
    for (const auto& [name, ms] : sums)
        state.counters[name] = ms / static_cast<double>(state.iterations());
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(run.counts().points));
    state.SetLabel(device().info().name);
}
BENCHMARK(mlsm_lists)
    ->ArgNames({"walls", "resolution", "linked"})
    ->ArgsProduct({{0, 1}, {512, 1024, 2048}, {0, 1}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
