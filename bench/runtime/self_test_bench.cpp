// SPDX-License-Identifier: MIT
// The self-test of every start: the device's time, and two contended atomics per item.
#include "bench/support/bench.h"
#include "runtime/kernel.h"
#include "runtime/self_test.h"

namespace penumbra::bench {
namespace {

void self_test(benchmark::State& state) {
    const auto items = static_cast<int>(state.range(0));
    runtime::selfTest(program("frame"));
    runtime::Buffer<std::uint32_t> results(device(), "results", 4);
    runtime::Kernel<int, runtime::Buffer<std::uint32_t>> kernel(program("frame"), "self_test");
    measure(state, [&] {
        results.fill(0);
        kernel.launch({static_cast<std::uint64_t>(items)}, {64}, items, results);
    });
    if (results.download()[1] != static_cast<std::uint32_t>(items))
        state.SkipWithError("items are missing");
    state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(self_test)->ArgName("items")->Arg(1000)->Arg(1 << 20)->UseManualTime()->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
