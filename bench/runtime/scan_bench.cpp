// SPDX-License-Identifier: MIT
// Prefix sums: values per second, bytes read and written per second (each value twice read, once
// written).
#include "bench/support/bench.h"
#include "runtime/scan.h"

namespace penumbra::bench {
namespace {

void scan(benchmark::State& state) {
    const auto count = static_cast<std::uint32_t>(state.range(0));
    runtime::Buffer<std::uint32_t> values(device(), "values", count), total(device(), "total", 1);
    runtime::Scan pass(program("frame"));
    values.fill(1);
    pass.run(values, count, total);
    if (total.download()[0] != count) state.SkipWithError("the sum is wrong");
    measure(state, [&] { pass.run(values, count, total); });
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.SetBytesProcessed(state.iterations() * state.range(0) * 12);
}
BENCHMARK(scan)
    ->ArgName("count")
    ->RangeMultiplier(16)
    ->Range(1 << 12, 1 << 24)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
