// SPDX-License-Identifier: MIT
// Points and splats of vwss on the built-in scene, by variant and number of maps.
#include <bit>

#include "bench/support/bench.h"
#include "host/visibility/depth_warp.h"
#include "host/visibility/points.h"
#include "host/visibility/vwss.h"

namespace penumbra::bench {
namespace {

using namespace visibility;
using runtime::Buffer;

/// Points of the built-in scene for maps of 1024^2, with room for `views` maps.
struct Splat {
    explicit Splat(int views, const runtime::Program& used = program("multi_view"))
        : light(lightWith(views)),
          view(fitLightView(light, builtinScene().bounds, builtinScene().bounds.centre(), 1024, 1)),
          points(used, Cull::automatic, Precision::single),
          samples(device(), "samples", view.samples),
          counters(device(), "counters", 1),
          maps(device(), "maps",
               static_cast<std::uint64_t>(view.params.mapStride) *
                   static_cast<std::uint64_t>(views)) {
        view.params.depthBits = 32;
        points.grow(1 << 20);
        generate();
        count = counters.download()[0].points;
    }
    void generate() {
        points.adapt(builtinScene().mesh(), view);
        counters.fill({});
        points.run(builtinScene().mesh(), view, counters);
    }
    scene::AreaLight light;
    LightView view;
    Points points;
    Buffer<float> samples;
    Buffer<shared::MultiViewCounters> counters;
    Buffer<std::uint32_t> maps;
    std::int64_t count = 0;
};

/// Triangles to points: points per second, bytes appended per second. With `buffer` 1 every
/// fragment is appended with an atomic of its own; else a work-item appends that many at a time.
void points(benchmark::State& state) {
    const runtime::Program used(device(), "multi_view",
                                {fmt::format("POINT_BUFFER={}", state.range(0))});
    Splat splat(1, used);
    measure(state, [&] { splat.generate(); });
    state.SetItemsProcessed(state.iterations() * splat.count);
    state.SetBytesProcessed(state.iterations() * splat.count * 12);
}
BENCHMARK(points)->ArgName("buffer")->Arg(1)->Arg(4)->Arg(64)->Arg(256)->UseManualTime()->Unit(
    benchmark::kMillisecond);

/// Points to maps: splats (points x maps) per second. Each form is checked against the first one's
/// maps.
void depth_warp(benchmark::State& state) {
    const auto form = static_cast<Parallelism>(state.range(0));
    const auto views = static_cast<int>(state.range(1));
    Splat splat(views);
    const MapBatch batch{0, views, &splat.maps, nullptr};
    const auto warp = [&](Parallelism p) {
        DepthWarp(program("multi_view"), p, 8)
            .run(splat.points.buffers(), splat.view, splat.samples, batch, splat.counters);
    };
    warp(Parallelism::full);
    const auto texels = static_cast<std::uint64_t>(splat.view.params.resolution) * 1024;
    const auto expected = splat.maps.download(0, texels);
    DepthWarp pass(program("multi_view"), form, 8);
    measure(state, [&] {
        pass.run(splat.points.buffers(), splat.view, splat.samples, batch, splat.counters);
    });
    if (splat.maps.download(0, texels) != expected) state.SkipWithError("the maps differ");
    state.SetItemsProcessed(state.iterations() * splat.count * views);
    state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(texels) * 4 * views);
}
BENCHMARK(depth_warp)
    ->ArgNames({"form", "maps"})  // 1 serial, 2 partial, 3 full, 4 owned
    ->ArgsProduct({{1, 2, 3, 4}, {8, 24, 128}})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// Triangles straight to maps, without a point buffer.
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
