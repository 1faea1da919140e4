// SPDX-License-Identifier: MIT
// The whole G-buffer of the built-in scene: raster and resolve.
#include "bench/support/bench.h"
#include "host/gbuffer/gbuffer.h"

namespace penumbra::bench {
namespace {

/// The whole pass on the built-in scene: pixels per second.
void gbuffer(benchmark::State& state) {
    auto& posed = builtinScene();
    scene::CameraChoice choice;
    const auto pose = scene::poseAt(posed.scene, scene::chooseAnimations(posed.scene, ""), 0.25);
    const auto camera = scene::cameraAt(posed.scene, pose, choice, posed.bounds, 16.0 / 9);
    gbuffer::GBufferPass pass(program("frame"), 1280, 720);
    const auto work = [&] { pass.run(posed.mesh(), camera, posed.bounds.centre()); };
    do work();
    while (pass.grew());
    measure(state, work);
    state.SetItemsProcessed(state.iterations() * 1280 * 720);
}
BENCHMARK(gbuffer)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
