// SPDX-License-Identifier: MIT
// Leaving out receivers that no caster can shadow: triangles marked and receivers asked per second.
#include "bench/support/bench.h"
#include "host/visibility/occupancy.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/multi_view.h"

namespace penumbra::bench {
namespace {

void occupancy(benchmark::State& state) {
    auto& posed = builtinScene();
    const auto view =
        visibility::fitLightView(posed.light, posed.bounds, posed.bounds.centre(), 1024, 1);
    const int stride = shared::gbufferStride(1280 * 720);
    // Half of the receivers at the rim of the view, where nothing is
    std::vector<float> planes(static_cast<std::size_t>(RECEIVER_PLANES * stride), 0.5F);
    for (int i = 0; i < stride; ++i) {
        planes[static_cast<std::size_t>(RECEIVER_A * stride + i)] = i % 1280 < 640 ? 10.0F : 512.0F;
        planes[static_cast<std::size_t>(RECEIVER_FACING * stride + i)] = 1e6F;
    }
    runtime::Buffer<float> receivers(device(), "receivers", planes);
    visibility::Occupancy pass(program("multi_view"));
    measure(state, [&] { pass.skip(posed.mesh(), view, stride, receivers); });
    state.SetItemsProcessed(state.iterations() * posed.mesh().triangleCount);
}
BENCHMARK(occupancy)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
