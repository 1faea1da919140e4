// SPDX-License-Identifier: MIT
// Points of the built-in scene to depth maps of 1024^2: splats (points x maps) per second, bytes of
// finished maps per second, by form, number of maps, texel and stored precision.
#include "bench/support/splat.h"
#include "host/visibility/depth_warp.h"

namespace penumbra::bench {
namespace {

using namespace visibility;

/// Each form is checked against the first one's maps.
void depth_warp(benchmark::State& state) {
    const auto form = static_cast<Parallelism>(state.range(0));
    const auto views = static_cast<int>(state.range(1));
    const auto bits = static_cast<int>(state.range(2));
    Splat splat(views, program("multi_view"), static_cast<Precision>(state.range(3)));
    splat.view.params.depthBits = bits;
    const auto texels =
        static_cast<std::uint64_t>(splat.view.params.mapStride) * static_cast<std::uint64_t>(views);
    runtime::Buffer<std::uint16_t> maps16(device(), "maps", bits == 16 ? texels : 1);
    const MapBatch batch{0, views, &splat.maps, bits == 16 ? &maps16 : nullptr};
    const auto warp = [&](DepthWarp& pass) {
        pass.run(splat.points.buffers(), splat.view, splat.samples, batch, splat.counters);
    };
    const auto firstMap = [&] {
        std::vector<std::uint32_t> map;
        if (bits == 32) return splat.maps.download(0, 1024 * 1024);
        for (const auto depth : maps16.download(0, 1024 * 1024)) map.push_back(depth);
        return map;
    };
    DepthWarp first(program("multi_view"), Parallelism::full, 8),
        pass(program("multi_view"), form, 8);
    warp(first);
    const auto expected = firstMap();
    measure(state, [&] { warp(pass); });
    if (firstMap() != expected) state.SkipWithError("the maps differ");
    state.SetItemsProcessed(state.iterations() * splat.count * views);
    state.SetBytesProcessed(state.iterations() * 1024 * 1024 * (bits / 8) * views);
}
BENCHMARK(depth_warp)
    ->ArgNames({"form", "maps", "bits",
                "precision"})  // forms: 1 serial, 2 partial, 3 full, 4 owned
    ->ArgsProduct({{1, 2, 3, 4}, {8, 24, 128}, {32}, {0}})
    ->ArgsProduct({{3, 4}, {24}, {16}, {0}})
    ->ArgsProduct({{3, 4}, {24}, {32}, {1, 2}})  // 1 half, 2 fixed
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
