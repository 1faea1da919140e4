// SPDX-License-Identifier: MIT
// FLIP of colour pictures on the host: pixels per second.
#include "bench/metrics/pictures.h"
#include "bench/support/bench.h"
#include "host/metrics/flip.h"

namespace penumbra::bench {
namespace {

void flip(benchmark::State& state) {
    const auto width = static_cast<int>(state.range(0)), height = width * 9 / 16;
    const auto a = noise(width, height, 1), b = noise(width, height, 2);
    for (auto _ : state) benchmark::DoNotOptimize(metrics::flip(a, b).mean);
    state.SetItemsProcessed(state.iterations() * width * height);
    state.SetLabel("host, one core");
}
BENCHMARK(flip)->ArgNames({"width"})->Arg(960)->Arg(1920)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
