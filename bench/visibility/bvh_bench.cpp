// SPDX-License-Identifier: MIT
// Building the tree: triangles of the built-in scene per second, keys and sort included.
#include "bench/support/bench.h"
#include "host/visibility/bvh.h"

namespace penumbra::bench {
namespace {

void bvh(benchmark::State& state) {
    auto& posed = builtinScene();
    visibility::Bvh tree(program("frame"), program("raytrace"));
    const auto clips = scene::chooseAnimations(posed.scene, "");
    double seconds = 0.25;
    const auto move = [&] {
        // Another pose each time: a mesh at rest keeps its tree
        posed.geometry->run(scene::poseAt(posed.scene, clips, seconds += 0.001));
        device().profiler().collect();
    };
    const auto build = [&] { tree.build(posed.mesh(), posed.bounds, posed.bounds.centre()); };
    build();
    for (auto _ : state) {
        move();
        state.SetIterationTime(1e-3 * deviceMs(build));
    }
    posed.geometry->run(scene::poseAt(posed.scene, clips, 0.25));
    state.SetItemsProcessed(state.iterations() * tree.params().casterCount);
    state.SetLabel(device().info().name);
}
BENCHMARK(bvh)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
