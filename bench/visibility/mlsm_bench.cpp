// SPDX-License-Identifier: MIT
// Filtered multi-layer shadow maps by stage: lists of the base level (array and linked list),
// merging (pyramid and stack), lookup of 1280 x 720 receivers.
#include "bench/support/technique_run.h"

namespace penumbra::bench {
namespace {

SettingValues settingsOf(std::int64_t resolution, SettingValues more = {}) {
    more["mlsm.resolution"] = std::to_string(resolution);
    return more;
}

PosedScene& sceneOf(std::int64_t walls) {
    return walls ? wallScene() : builtinScene();
}

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
