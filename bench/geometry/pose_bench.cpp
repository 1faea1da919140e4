// SPDX-License-Identifier: MIT
#include "bench/support/bench.h"
#include "host/scene/animation.h"

namespace penumbra::bench {
namespace {

/// Skinning the built-in scene: vertices per second, bytes written per second.
void pose(benchmark::State& state) {
    auto& posed = builtinScene();
    const auto clips = scene::chooseAnimations(posed.scene, "");
    double seconds = 0;
    measure(state,
            [&] { posed.geometry->run(scene::poseAt(posed.scene, clips, seconds += 0.01)); });
    const auto vertices = static_cast<std::int64_t>(posed.mesh().vertexCount);
    state.SetItemsProcessed(state.iterations() * vertices);
    state.SetBytesProcessed(state.iterations() * vertices * 10 * 4);
}
BENCHMARK(pose)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
