// SPDX-License-Identifier: MIT
// Averaging visibility over a window of frames of the built-in scene at rest.
#include "bench/support/bench.h"
#include "bench/support/builtin_frame.h"
#include "host/shading/temporal.h"

namespace penumbra::bench {
namespace {

/// Pixels per second of one light, what the next frame compares with included; bytes: histories
/// read and written, visibility, and the 8 planes and words that say where a surface was.
void temporal(benchmark::State& state) {
    const auto window = static_cast<int>(state.range(0)),
               channels = static_cast<int>(state.range(1));
    BuiltinFrame frame;
    const auto& gbuffer = frame.gbuffer();
    const auto centre = builtinScene().bounds.centre();
    shading::Temporal pass(program("frame"), gbuffer.width, gbuffer.height, window);
    visibility::Visibility visibility;
    visibility.channels = channels;
    frame.fill(visibility);
    const auto work = [&] {
        pass.run(gbuffer, 0, visibility);
        pass.endFrame(gbuffer, frame.camera, centre);
    };
    for (int i = 0; i < window; ++i) work();  // a full window
    measureStage(state, "temporal", work);
    state.SetItemsProcessed(state.iterations() * frame.pixels());
    state.SetBytesProcessed(state.iterations() * frame.pixels() *
                            (2 * (window - 1) * channels + 2 * channels + 8) * 4);
}
BENCHMARK(temporal)
    ->ArgNames({"window", "channels"})
    ->ArgsProduct({{2, 4, 8, 16}, {1}})
    ->Args({8, 3})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
