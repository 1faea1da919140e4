// SPDX-License-Identifier: MIT
// OpenGL (Mesa's llvmpipe) draws the casters of the built-in scene into depth maps of 1024^2, from
// the views that map_raster has: (triangles x maps) per second of wall clock by form, number of
// maps and threads; and in turn with the OpenCL forms.
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <ctime>
#include <functional>
#include <map>
#include <thread>

#include "bench/support/egl_maps.h"
#include "bench/support/splat.h"
#include "host/visibility/depth_warp.h"
#include "host/visibility/map_raster.h"
#include "runtime/error.h"

namespace penumbra::bench {
namespace {

using namespace visibility;

constexpr int kHeld = 8;  // maps at a time, as techniques hold them on CPUs

/// Milliseconds of wall clock and of all threads of the process.
struct Times {
    double wall, cpu;
};

Times measured(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    const auto cpu = std::clock();
    work();
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    return {wall.count(), 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC};
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

int allCores() {
    return static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
}

/// Depth maps in OpenCL, kHeld at a time.
class OpenClMaps {
  public:
    explicit OpenClMaps(int views)
        : splat(views),
          textbook_(program("mvr"), {MapForm::textbook}),
          full_(program("mvr"), {MapForm::full}),
          warp_(program("multi_view"), Parallelism::automatic, 8) {
        do textbook();
        while (textbook_.grew());
        do full();
        while (full_.grew());
        vwss();
    }

    void textbook() { raster(textbook_); }
    void full() { raster(full_); }
    void vwss() {
        splat.generate();
        inBatches([&](const MapBatch& batch) {
            warp_.run(splat.points.buffers(), splat.view, splat.samples, batch, splat.counters);
        });
    }
    /// The map that was filled first in the last batch, by `full`.
    std::vector<float> lastMap() {
        full();
        std::vector<float> depths;
        for (const auto bits : splat.maps.download(0, 1024 * 1024))
            depths.push_back(std::bit_cast<float>(bits));
        return depths;
    }

    Splat splat;

  private:
    template <typename Fill>
    void inBatches(const Fill& fill) {
        const int views = splat.view.params.views;
        for (int first = 0; first < views; first += kHeld)
            fill({first, std::min(kHeld, views - first), &splat.maps, nullptr});
        device().finish();
    }
    void raster(MapRaster& pass) {
        auto& posed = builtinScene();
        const gbuffer::GBuffer unused;
        pass.begin({posed.mesh(), unused, splat.light, posed.bounds, posed.bounds.centre()},
                   splat.view, splat.samples, splat.counters);
        inBatches([&](const MapBatch& batch) { pass.fill(batch); });
        pass.takeTriangles();
        device().profiler().collect();
    }

    MapRaster textbook_, full_;
    DepthWarp warp_;
};

/// Share of the texels that either map covers on which both have the same depth to 1e-4.
double agreement(const std::vector<float>& a, const std::vector<float>& b) {
    double covered = 0, equal = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i] <= 0 && b[i] <= 0) continue;
        ++covered;
        if (a[i] > 0 && b[i] > 0 && std::abs(a[i] - b[i]) <= 1e-4F) ++equal;
    }
    return covered > 0 ? equal / covered : 0;
}

/// Compares the map at which the last batch begins; triangles per second, label.
void finish(benchmark::State& state, OpenClMaps& openCl, const EglMaps& egl,
            const EglContext& context) {
    const double share = agreement(openCl.lastMap(), egl.download(0));
    state.counters["agreement"] = share;
    if (share < 0.99)
        state.SkipWithError(fmt::format("maps agree on {} of their texels", share).c_str());
    state.SetItemsProcessed(state.iterations() * openCl.splat.view.params.views *
                            static_cast<std::int64_t>(builtinScene().mesh().casterTriangleCount));
    state.SetLabel(context.description());
}

void map_raster_egl(benchmark::State& state) try {
    const auto views = static_cast<int>(state.range(1));
    OpenClMaps openCl(views);
    const EglContext context(static_cast<int>(state.range(2)));
    EglMaps egl(context, builtinScene().mesh(), openCl.splat.view, std::min(kHeld, views),
                static_cast<EglForm>(state.range(0)));
    egl.run();
    for (auto _ : state) state.SetIterationTime(1e-3 * measured([&] { egl.run(); }).wall);
    finish(state, openCl, egl, context);
} catch (const Error& error) {
    state.SkipWithError(error.what());
}
BENCHMARK(map_raster_egl)
    ->ArgNames({"layered", "maps", "threads"})
    ->ArgsProduct({{0, 1}, {1, 24, 128}, {0, 1, allCores()}})
    ->MeasureProcessCPUTime()
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// All in turn, each once a round. The time is that of OpenGL; counters are medians in ms, of wall
/// clock and of the process's threads together.
void map_raster_egl_in_turn(benchmark::State& state) try {
    const auto views = static_cast<int>(state.range(0));
    OpenClMaps openCl(views);
    const EglContext context(static_cast<int>(state.range(1)));
    EglMaps egl(context, builtinScene().mesh(), openCl.splat.view, std::min(kHeld, views),
                EglForm::perView);
    const std::pair<const char*, std::function<void()>> rivals[] = {
        {"opengl", [&] { egl.run(); }},
        {"textbook", [&] { openCl.textbook(); }},
        {"full", [&] { openCl.full(); }},
        {"vwss", [&] { openCl.vwss(); }}};
    std::map<std::string, std::vector<double>> times;
    egl.run();
    for (auto _ : state) {
        for (const auto& [name, run] : rivals) {
            const auto time = measured(run);
            times[name].push_back(time.wall);
            times[std::string(name) + "_cpu"].push_back(time.cpu);
        }
        state.SetIterationTime(1e-3 * times["opengl"].back());
    }
    for (const auto& [name, values] : times) state.counters[name] = median(values);
    finish(state, openCl, egl, context);
} catch (const Error& error) {
    state.SkipWithError(error.what());
}
BENCHMARK(map_raster_egl_in_turn)
    ->ArgNames({"maps", "threads"})
    ->ArgsProduct({{1, 24, 128}, {1, allCores()}})
    ->Iterations(9)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
