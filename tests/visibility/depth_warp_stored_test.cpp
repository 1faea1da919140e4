// SPDX-License-Identifier: MIT
// Warping points as they are stored: halves, fixed point, 16-bit maps, and keys of partial opacity.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <random>

#include "tests/reference/depth_warp_ref.h"
#include "tests/reference/points_run.h"
#include "tests/support/fixtures.h"
#include "tests/support/textured_scene.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using visibility::Parallelism;
using visibility::Precision;
using U32 = std::uint32_t;

class StoredPointsTest : public testing::TestWithParam<std::tuple<Precision, Parallelism, int>> {};

TEST_P(StoredPointsTest, AreDecodedAsTheTwinDecodesThem) {
    const auto [precision, form, bits] = GetParam();
    PointsSetup setup;
    setup.resolution = 301;
    setup.density = 1.3;
    setup.precision = precision;
    PointsRun run(texturedScene(8, 40, {Surface::opaque}), setup);
    std::vector<WarpPoint> points;
    for (const auto& p : run.points()) points.push_back({p.a, p.b, p.w});
    const auto maps = run.warpedMaps(form, bits);
    std::size_t filled = 0, different = 0;
    for (std::size_t v = 0; v < maps.size(); ++v) {
        const auto twin =
            warpPoints(points, run.view.samples[2 * v], run.view.samples[2 * v + 1], 301);
        for (std::size_t i = 0; i < twin.size(); ++i) {
            filled += twin[i] > 0;
            // Half of a step of 16 bits, and what float loses when it decodes
            different += std::abs(maps[v][i] - twin[i]) > (bits == 16 ? 0.51 / 65535 : 2e-7);
        }
    }
    EXPECT_GT(filled, 4000U);
    // Float moves a point in some thousand over a texel's border
    EXPECT_LE(different, 4 + filled / 500);
}

INSTANTIATE_TEST_SUITE_P(
    Forms, StoredPointsTest,
    testing::Combine(testing::Values(Precision::single, Precision::half, Precision::fixed),
                     testing::Values(Parallelism::partial, Parallelism::full, Parallelism::owned),
                     testing::Values(16, 32)));

/// Points of partial opacity, each over a texel of its own in every view.
struct Sheet {
    explicit Sheet(int count) : views(count) {
        std::mt19937 random(static_cast<unsigned>(count));
        for (int i = 0; i < kCount; ++i) {
            opacity.push_back(i < 3 ? 2048U * static_cast<U32>(i)
                                    : static_cast<U32>(random()) % 4097);
            keys.push_back(opacity.back() << 19 | (static_cast<U32>(random()) & 0x7ffffU));
        }
    }
    /// Per point whether each view holds it; `order`: which point lies in which slot.
    std::vector<std::vector<bool>> warp(Parallelism form,
                                        const std::vector<std::size_t>& order) const {
        visibility::LightView view;
        auto& p = view.params;
        p.resolution = kSize;
        p.mapStride = (kSize * kSize + 16) / 16 * 16;
        p.views = views;
        p.pointCapacity = kCount;
        p.depthBits = 32;
        p.alphaKeys = 1;
        p.sampleStride = std::max(views * 5 / 8, 1);
        while (std::gcd(p.sampleStride, views) != 1) ++p.sampleStride;
        std::vector<float> planes(3 * kCount, 0.5F);
        std::vector<U32> stored;
        for (std::size_t slot = 0; slot < kCount; ++slot) {
            planes[slot] = static_cast<float>(order[slot] % kSize) + 0.5F;
            planes[kCount + slot] = static_cast<float>(order[slot] / kSize) + 0.5F;
            stored.push_back(keys[order[slot]]);
        }
        visibility::PointBuffers buffers;
        buffers.points32 = Buffer<float>(device(), "points", planes);
        buffers.points16 = Buffer<std::uint16_t>(device(), "points", 1);
        buffers.keys = Buffer<U32>(device(), "keys", stored);
        Buffer<float> samples(device(), "samples",
                              std::vector<float>(2 * static_cast<std::size_t>(views), 0.0F));
        shared::MultiViewCounters counted{};
        counted.points = kCount;
        Buffer<shared::MultiViewCounters> counters(device(), "counters",
                                                   std::vector<shared::MultiViewCounters>{counted});
        const auto stride = static_cast<std::size_t>(p.mapStride);
        Buffer<U32> maps(device(), "maps", stride * static_cast<std::size_t>(views));
        visibility::DepthWarp(program("multi_view"), form, 5)
            .run(buffers, view, samples, {0, views, &maps, nullptr}, counters);
        const auto depths = maps.download();
        std::vector<std::vector<bool>> held(kCount);
        for (std::size_t i = 0; i < kCount; ++i)
            for (std::size_t v = 0; v < static_cast<std::size_t>(views); ++v)
                held[i].push_back(depths[v * stride + i] != 0);
        return held;
    }
    static constexpr int kSize = 33, kCount = 1001;
    int views;
    std::vector<U32> opacity, keys;  ///< opacity in 1/4096
};

TEST(PartialOpacityTest, BlocksItsShareOfTheViewsInAShuffleThatKnowsNoOrder) {
    std::vector<std::size_t> order(Sheet::kCount), shuffled;
    std::iota(order.begin(), order.end(), std::size_t{0});
    shuffled = order;
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(5));
    for (const int views : {2, 7, 12, 63, 64, 300}) {
        const Sheet sheet(views);
        const auto held = sheet.warp(Parallelism::owned, order);
        std::size_t patterns = 0;
        for (std::size_t i = 0; i < held.size(); ++i) {
            // Sample r of N is blocked where a > (r + 0.5) / N
            std::ptrdiff_t expected = 0;
            for (int r = 0; r < views; ++r)
                expected += sheet.opacity[i] / 4096.0 > (r + 0.5) / views;
            EXPECT_EQ(std::count(held[i].begin(), held[i].end(), true), expected) << views;
            patterns += i > 3 && expected > 0 && expected < views && !held[i][0];
        }
        EXPECT_GT(patterns, views > 2 ? 100U : 0U);  // not always the first views
        EXPECT_EQ(sheet.warp(Parallelism::full, order), held) << views;
        EXPECT_EQ(sheet.warp(Parallelism::full, shuffled), held) << views;
    }
}

}  // namespace
}  // namespace penumbra::tests
