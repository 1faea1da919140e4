// SPDX-License-Identifier: MIT
// Exponential maps of the built-in scene by resolution: both depth maps and the pyramid (texels of
// the map per second), and lighting of 1280 x 720 (receivers per second).
#include "bench/support/technique_run.h"

namespace penumbra::bench {
namespace {

void measureEssm(benchmark::State& state, const char* stage, bool texels) {
    TechniqueRun run(builtinScene(), "essm", {{"essm.resolution", std::to_string(state.range(0))}},
                     1);
    for (auto _ : state) state.SetIterationTime(1e-3 * run.stages()[stage]);
    state.SetItemsProcessed(state.iterations() *
                            (texels ? state.range(0) * state.range(0) : run.tested()));
    state.SetLabel(device().info().name);
}

void essm_build(benchmark::State& state) {
    measureEssm(state, "depth maps", true);
}
BENCHMARK(essm_build)
    ->ArgName("resolution")
    ->Arg(512)
    ->Arg(1024)
    ->Arg(2048)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

void essm_lookup(benchmark::State& state) {
    measureEssm(state, "lighting", false);
}
BENCHMARK(essm_lookup)
    ->ArgName("resolution")
    ->Arg(512)
    ->Arg(1024)
    ->Arg(2048)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
