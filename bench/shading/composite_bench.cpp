// SPDX-License-Identifier: MIT
// Compositing layers of fragments over a whole screen.
#include "bench/support/bench.h"
#include "host/shading/composite.h"

namespace penumbra::bench {
namespace {

constexpr int kWidth = 1280, kHeight = 720;

/// Fragments per second; bytes: colour and coverage of fragments, colour of pixels read and
/// written, their ends, alpha, front and object.
void composite(benchmark::State& state) {
    const auto layers = static_cast<std::uint32_t>(state.range(0));
    gbuffer::FragmentLists lists;
    lists.pixels = kWidth * kHeight;
    lists.capacity = layers * kWidth * kHeight;
    std::vector<std::uint32_t> ends(static_cast<std::size_t>(lists.pixels));
    for (std::size_t i = 0; i < ends.size(); ++i)
        ends[i] = layers * static_cast<std::uint32_t>(i + 1);
    lists.ends = runtime::Buffer<std::uint32_t>(device(), "ends", ends);
    lists.coverage = runtime::Buffer<float>(device(), "coverage", COVERAGE_PLANES * lists.capacity);
    lists.coverage.fill(0.5F);
    gbuffer::GBuffer gbuffer;
    gbuffer.width = kWidth;
    gbuffer.height = kHeight;
    gbuffer.fragmentRows = static_cast<int>(layers) * kHeight;
    gbuffer.planeStride = shared::gbufferStride(kWidth * gbuffer.rows());
    const auto stride = static_cast<std::uint64_t>(gbuffer.planeStride);
    gbuffer.planes = runtime::Buffer<float>(device(), "planes", GB_PLANES * stride);
    gbuffer.planes.fill(1);
    gbuffer.blended = &lists;
    runtime::Buffer<float> colour(device(), "colour", 3 * stride);
    colour.fill(0.5F);
    shading::Composite pass(program("frame"), kWidth, kHeight);
    measureStage(state, "composite", [&] { pass.run(gbuffer, colour); });
    const auto pixels = static_cast<std::int64_t>(lists.pixels);
    state.SetItemsProcessed(state.iterations() * lists.capacity);
    state.SetBytesProcessed(state.iterations() * (std::int64_t{lists.capacity} * 7 + pixels * 10) *
                            4);
}
BENCHMARK(composite)->ArgName("layers")->Arg(1)->Arg(4)->UseManualTime()->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace penumbra::bench
