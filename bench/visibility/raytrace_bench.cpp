// SPDX-License-Identifier: MIT
// Shadow rays per second of the built-in scene at 640 x 360, by light samples; the tree stands.
#include <algorithm>

#include "bench/support/bench.h"
#include "host/gbuffer/gbuffer.h"
#include "host/visibility/raytrace.h"

namespace penumbra::bench {
namespace {

constexpr int kWidth = 640, kHeight = 360;

void raytrace(benchmark::State& state) {
    auto& posed = builtinScene();
    const auto light = lightWith(static_cast<int>(state.range(0)));
    const auto pose = scene::poseAt(posed.scene, scene::chooseAnimations(posed.scene, ""), 0.25);
    const auto camera = scene::cameraAt(posed.scene, pose, {}, posed.bounds, 16.0 / 9);
    gbuffer::GBufferPass gbufferPass(program("frame"), kWidth, kHeight);
    do gbufferPass.run(posed.mesh(), camera, posed.bounds.centre());
    while (gbufferPass.grew());
    visibility::Bvh tree(program("frame"), program("raytrace"));
    visibility::RayPass pass(program("raytrace"), kWidth, kHeight);
    tree.build(posed.mesh(), posed.bounds, posed.bounds.centre());
    const auto& gbuffer = gbufferPass.result();
    visibility::Visibility visibility;
    visibility.channels = posed.mesh().hasBlend ? 3 : 1;
    const auto stride = static_cast<std::uint64_t>(gbuffer.planeStride);
    visibility.planes = runtime::Buffer<float>(device(), "visibility", 3 * stride);
    visibility.state = runtime::Buffer<std::uint32_t>(device(), "states", stride);
    measure(state, [&] {
        pass.run({posed.mesh(), gbuffer, light, posed.bounds, posed.bounds.centre()}, tree,
                 STATE_TESTED, true, visibility);
    });
    const auto states = visibility.state.download();
    state.SetItemsProcessed(state.iterations() * state.range(0) *
                            std::count(states.begin(), states.end(), STATE_TESTED));
}
BENCHMARK(raytrace)->ArgName("samples")->Arg(16)->Arg(64)->Arg(256)->UseManualTime()->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
