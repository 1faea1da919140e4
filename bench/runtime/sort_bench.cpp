// SPDX-License-Identifier: MIT
// Radix sort: pairs per second by their number and the keys' bits; bytes of a digit's two passes.
#include <algorithm>
#include <random>

#include "bench/support/bench.h"
#include "runtime/sort.h"

namespace penumbra::bench {
namespace {

void sort(benchmark::State& state) {
    const auto count = static_cast<std::uint32_t>(state.range(0));
    const auto bits = static_cast<int>(state.range(1));
    std::mt19937 random(1);
    std::vector<std::uint32_t> shuffled(count);
    for (auto& key : shuffled)
        key = static_cast<std::uint32_t>(random()) >> static_cast<unsigned>(32 - bits);
    runtime::Buffer<std::uint32_t> original(device(), "shuffled keys", shuffled);
    runtime::Buffer<std::uint32_t> keys(device(), "keys", count), values(device(), "values", count);
    runtime::Sort pass(program("frame"));
    const auto work = [&] {
        keys.copyFrom(original, count);  // no launch: outside of the stages' time
        pass.run(keys, values, count, bits);
    };
    measure(state, work);
    const auto sorted = keys.download();
    if (!std::is_sorted(sorted.begin(), sorted.end())) state.SkipWithError("the keys are unsorted");
    state.SetItemsProcessed(state.iterations() * state.range(0));
    state.SetBytesProcessed(state.iterations() * state.range(0) * (bits / 8) * 20);
}
BENCHMARK(sort)
    ->ArgNames({"count", "bits"})
    ->ArgsProduct({{1 << 12, 1 << 16, 1 << 20}, {16, 32}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
