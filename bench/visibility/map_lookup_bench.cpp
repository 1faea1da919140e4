// SPDX-License-Identifier: MIT
// Lighting: shadow tests per second of the built-in scene at 1280 x 720, by filter, texel and
// number of maps.
#include <algorithm>

#include "bench/support/bench.h"
#include "host/gbuffer/gbuffer.h"
#include "host/visibility/technique.h"
#include "kernels/shared/multi_view.h"

namespace penumbra::bench {
namespace {

constexpr int kWidth = 1280, kHeight = 720;

/// Milliseconds of the stage "lighting" of what was enqueued.
double lightingMs() {
    for (const auto& stage : device().profiler().collect())
        if (stage.name == "lighting") return stage.deviceMs;
    return 0;
}

void map_lookup(benchmark::State& state) {
    const char* filters[] = {"1", "5", "9", "bilinear"};
    const int taps[] = {1, 5, 9, 4};
    const auto filter = static_cast<std::size_t>(state.range(0));
    const SettingValues settings = {{"vwss.pcf", filters[filter]},
                                    {"vwss.depthBits", std::to_string(state.range(1))}};
    auto& posed = builtinScene();
    const auto light = lightWith(static_cast<int>(state.range(2)));
    const auto pose = scene::poseAt(posed.scene, scene::chooseAnimations(posed.scene, ""), 0.25);
    const auto camera = scene::cameraAt(posed.scene, pose, {}, posed.bounds, 16.0 / 9);
    gbuffer::GBufferPass pass(program("frame"), kWidth, kHeight);
    const auto technique =
        visibility::findTechnique("vwss").make({device(), settings, kWidth, kHeight});
    const auto& gbuffer = pass.run(posed.mesh(), camera, posed.bounds.centre());
    const auto stride = static_cast<std::uint64_t>(gbuffer.planeStride);
    visibility::Visibility visibility;
    visibility.planes = runtime::Buffer<float>(device(), "visibility", stride);
    visibility.state = runtime::Buffer<std::uint32_t>(device(), "states", stride);
    const auto run = [&] {
        technique->run({posed.mesh(), gbuffer, light, posed.bounds, posed.bounds.centre()},
                       visibility);
    };
    do run();
    while (technique->grew());
    device().profiler().collect();
    const auto states = visibility.state.download();
    const auto tested = std::count(states.begin(), states.end(), STATE_TESTED);
    for (auto _ : state) {
        technique->takeCounts();
        run();
        state.SetIterationTime(1e-3 * lightingMs());
    }
    state.SetItemsProcessed(state.iterations() * tested * taps[filter] * state.range(2));
    state.SetLabel(device().info().name);
}
BENCHMARK(map_lookup)
    ->ArgNames({"filter", "bits", "maps"})
    ->ArgsProduct({{0, 1, 2, 3}, {16, 32}, {24}})
    ->Args({1, 32, 128})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
