// SPDX-License-Identifier: MIT
// Warping points against its double-precision twin, on counts that fill no whole vector.
#include "host/visibility/depth_warp.h"

#include <bit>
#include <random>

#include "tests/reference/depth_warp_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using namespace visibility;
using runtime::Buffer;

constexpr int kSize = 67, kViews = 3;
constexpr std::uint32_t kCapacity = 4096;

class DepthWarpTest : public testing::TestWithParam<std::tuple<Parallelism, int>> {};

TEST_P(DepthWarpTest, MatchesTheTwinAwayFromTexelBorders) {
    const auto [form, count] = GetParam();
    std::mt19937 random(static_cast<unsigned>(count));
    std::uniform_real_distribution<float> place(-20.0F, kSize + 20.0F), depth(0.05F, 1.3F);
    std::vector<float> planes(3 * kCapacity, 0.0F);
    std::vector<WarpPoint> points;
    for (int i = 0; i < count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        planes[at] = place(random);
        planes[kCapacity + at] = place(random);
        planes[2 * kCapacity + at] = depth(random);
        points.push_back({planes[at], planes[kCapacity + at], planes[2 * kCapacity + at]});
    }
    LightView view;
    view.params.resolution = kSize;
    view.params.mapStride = (kSize * kSize + 16) / 16 * 16;
    view.params.views = kViews;
    view.params.pointCapacity = kCapacity;
    view.params.precision = POINTS_FLOAT;
    view.params.depthBits = 32;
    view.samples = {0, 0, 11.5F, -7.25F, -30, 4};
    PointBuffers buffers;
    buffers.points32 = Buffer<float>(device(), "points", planes);
    buffers.points16 = Buffer<std::uint16_t>(device(), "points", 1);
    buffers.keys = Buffer<std::uint32_t>(device(), "keys", 1);
    Buffer<float> samples(device(), "samples", view.samples);
    shared::MultiViewCounters counted{};
    counted.points = static_cast<std::uint32_t>(count);
    Buffer<shared::MultiViewCounters> counters(device(), "counters",
                                               std::vector<shared::MultiViewCounters>{counted});
    Buffer<std::uint32_t> maps(device(), "maps",
                               static_cast<std::uint64_t>(view.params.mapStride) * kViews);
    DepthWarp(program("multi_view"), form, 2)
        .run(buffers, view, samples, {0, kViews, &maps, nullptr}, counters);
    const auto bits = maps.download();
    std::size_t different = 0;
    for (int v = 0; v < kViews; ++v) {
        const auto at = static_cast<std::size_t>(v);
        const auto twin = warpPoints(points, view.samples[2 * at], view.samples[2 * at + 1], kSize);
        for (std::size_t i = 0; i < twin.size(); ++i)
            different += std::bit_cast<float>(
                             bits[at * static_cast<std::size_t>(view.params.mapStride) + i]) !=
                         static_cast<float>(twin[i]);
    }
    // Float may round a point over a texel's border, which changes two texels; a bug changes
    // hundreds
    EXPECT_LE(different, 4U);
}

INSTANTIATE_TEST_SUITE_P(Forms, DepthWarpTest,
                         testing::Combine(testing::Values(Parallelism::serial, Parallelism::partial,
                                                          Parallelism::full, Parallelism::owned),
                                          testing::Values(0, 1, 15, 17, 1001, 4093)));

}  // namespace
}  // namespace penumbra::tests
