// SPDX-License-Identifier: MIT
// Reflectance of one light at the pixels of the built-in scene, by the light's shape.
#include "bench/support/bench.h"
#include "bench/support/builtin_frame.h"
#include "host/shading/shade.h"

namespace penumbra::bench {
namespace {

/// Pixels per second; bytes: the planes that a covered pixel reads, visibility, colour read and
/// written.
void shade(benchmark::State& state) {
    BuiltinFrame frame;
    auto light = lightWith(1);
    light.disk = state.range(0) == 16;
    if (state.range(0) == 0) light.width = light.height = 0;
    shading::Shade pass(program("frame"), frame.gbuffer().width, frame.gbuffer().height);
    visibility::Visibility visibility;
    visibility.channels = static_cast<int>(state.range(1));
    frame.fill(visibility);
    const auto centre = builtinScene().bounds.centre();
    pass.begin(frame.gbuffer(), glm::dvec3(0.1));
    measureStage(state, "shading",
                 [&] { pass.add(frame.gbuffer(), light, visibility, frame.camera, centre); });
    const std::int64_t pixels = frame.pixels();
    state.SetItemsProcessed(state.iterations() * pixels);
    state.SetBytesProcessed(state.iterations() * pixels * (16 + 6 + state.range(1)) * 4);
}
BENCHMARK(shade)
    ->ArgNames({"corners", "channels"})  // 0: a point, 4: a rectangle, 16: a disk
    ->ArgsProduct({{0, 4, 16}, {1}})
    ->Args({4, 3})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

/// Emission and ambient light.
void shade_begin(benchmark::State& state) {
    BuiltinFrame frame;
    shading::Shade pass(program("frame"), frame.gbuffer().width, frame.gbuffer().height);
    measureStage(state, "shading", [&] { pass.begin(frame.gbuffer(), glm::dvec3(0.1)); });
    state.SetItemsProcessed(state.iterations() * frame.pixels());
    state.SetBytesProcessed(state.iterations() * frame.pixels() * 9 * 4);
}
BENCHMARK(shade_begin)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
