// SPDX-License-Identifier: MIT
// Triangles of the built-in scene to points, by buffer and stored precision, and straight to maps.
#include "bench/support/splat.h"
#include "runtime/error.h"

namespace penumbra::bench {
namespace {

using namespace visibility;

/// Points per second, bytes appended per second. With `buffer` 1 every fragment is appended with an
/// atomic of its own; else a work-item appends that many at a time.
void points(benchmark::State& state) {
    const auto precision = static_cast<Precision>(state.range(1));
    const runtime::Program used(device(), "multi_view",
                                {fmt::format("POINT_BUFFER={}", state.range(0))});
    Splat splat(1, used, precision);
    measure(state, [&] { splat.generate(); });
    splat.points.grewTiles();
    state.SetItemsProcessed(state.iterations() * splat.count);
    state.SetBytesProcessed(state.iterations() * splat.count *
                            (precision == Precision::single ? 12 : 6));
}
BENCHMARK(points)
    ->ArgNames({"buffer", "precision"})  // 0 float, 1 half, 2 fixed
    ->ArgsProduct({{1, 4, 64, 256}, {0}})
    ->ArgsProduct({{256}, {1, 2}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// Splats (points x maps) per second, without a point buffer.
void points_direct(benchmark::State& state) {
    const auto views = static_cast<int>(state.range(0));
    Splat splat(views);
    shared::LookupParams all{};
    all.viewCount = views;
    measure(state, [&] {
        splat.maps.fill(0);
        splat.counters.fill({});
        splat.points.runDirect(builtinScene().mesh(), splat.view, all, splat.samples, splat.maps,
                               splat.counters);
    });
    splat.points.grewTiles();
    state.SetItemsProcessed(state.iterations() * splat.count * views);
}
BENCHMARK(points_direct)
    ->ArgName("maps")
    ->Arg(8)
    ->Arg(24)
    ->Arg(128)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
