// SPDX-License-Identifier: MIT
// Points against the twin: which pixels of the enlarged view make points, where they lie, what they
// carry.
#include "host/visibility/points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tests/reference/depth_warp_ref.h"
#include "tests/reference/points_ref.h"
#include "tests/reference/points_run.h"
#include "tests/support/fixtures.h"
#include "tests/support/textured_scene.h"

namespace penumbra::tests {
namespace {

using visibility::Cull;
using visibility::Precision;

bool neverClosed(int) {
    return false;
}

struct Comparison {
    std::size_t expected = 0, missing = 0, wrong = 0;
    std::map<int, std::set<std::uint32_t>> hashes;  ///< lower bits of the keys by draw
};

/// Pixel of the enlarged view that a point was made at: a - C grows with 1 + back w / near there.
std::pair<int, int> pixelOf(const PointsRun& run, const DevicePoint& p) {
    const auto& v = run.view.params;
    const double ratio =
        (1 + static_cast<double>(v.setBack) * p.w / v.near) * v.resolution / v.enlarged;
    const double middle = 0.5 * v.resolution, half = 0.5 * v.enlarged - 0.5;
    return {static_cast<int>(std::lround((p.a - middle) / ratio + half)),
            static_cast<int>(std::lround((p.b - middle) / ratio + half))};
}

bool agree(const DevicePoint& is, const PointReference& twin, bool keys) {
    if (std::abs(is.w - twin.w) > twin.slackW + 1e-6 || std::abs(is.a - twin.a) > twin.slackA ||
        std::abs(is.b - twin.b) > twin.slackB)
        return false;
    // Opacity in 1/4096; float textures are good for one more
    return !keys || std::abs((is.key >> 19) - twin.opacity * 4096) < 2;
}

/// Points pixel by pixel, those of a pixel by depth: both lists are unordered.
Comparison compare(const PointsRun& run, const std::vector<PointReference>& twin) {
    struct Pixel {
        std::vector<DevicePoint> is;
        std::vector<PointReference> expected;
    };
    std::map<std::pair<int, int>, Pixel> pixels;
    for (const auto& p : run.points()) pixels[pixelOf(run, p)].is.push_back(p);
    for (const auto& p : twin) pixels[{p.column, p.row}].expected.push_back(p);
    const bool keys = run.view.params.alphaKeys != 0;
    Comparison result;
    result.expected = twin.size();
    for (auto& [at, pixel] : pixels) {
        auto& [is, expected] = pixel;
        if (is.size() != expected.size()) {
            result.missing +=
                std::max(is.size(), expected.size()) - std::min(is.size(), expected.size());
            continue;
        }
        std::sort(is.begin(), is.end(), [](const auto& p, const auto& q) { return p.w < q.w; });
        std::sort(expected.begin(), expected.end(),
                  [](const auto& p, const auto& q) { return p.w < q.w; });
        for (std::size_t i = 0; i < is.size(); ++i) {
            result.wrong += !agree(is[i], expected[i], keys);
            if (is.size() == 1) result.hashes[expected[i].draw].insert(is[i].key & 0x7ffffU);
        }
    }
    return result;
}

/// Vertices that float snaps to another 1/256 pixel move an edge by that: one pixel in several
/// hundred along edges. A wrong rule, offset or face would change a tenth and more.
Comparison expectSame(const PointsRun& run, Cull cull, const std::function<bool(int)>& closed,
                      std::size_t least) {
    const auto twin = pointsReference(run.scene, run.pose, run.light, run.view, cull, closed);
    const auto result = compare(run, twin);
    EXPECT_EQ(run.counters.points, run.points().size());
    EXPECT_GE(result.expected, least);
    EXPECT_LE(result.missing, 2 + result.expected / 500) << "of " << result.expected;
    EXPECT_LE(result.wrong, 2 + result.expected / 1000) << "of " << result.expected;
    return result;
}

class PointsSurfaceTest : public testing::TestWithParam<std::vector<Surface>> {};

TEST_P(PointsSurfaceTest, EqualTheTwinInPlaceDepthAndOpacity) {
    for (unsigned seed = 1; seed <= 2; ++seed) {
        PointsSetup setup;
        setup.resolution = 501;
        const PointsRun run(texturedScene(seed, 25, GetParam()), setup);
        const auto result = expectSame(run, Cull::none, neverClosed, 3000);
        if (!run.view.params.alphaKeys) continue;
        std::set<std::uint32_t> all;
        for (const auto& [draw, hashes] : result.hashes) {
            // A pixel or two may have been matched to a neighbouring draw
            EXPECT_LE(hashes.size(), 2U) << draw;
            all.insert(hashes.begin(), hashes.end());
        }
        EXPECT_GE(all.size(), GetParam().size());
    }
}

INSTANTIATE_TEST_SUITE_P(
    Surfaces, PointsSurfaceTest,
    testing::Values(std::vector{Surface::opaque}, std::vector{Surface::maskNearest},
                    std::vector{Surface::maskSmooth}, std::vector{Surface::blend},
                    std::vector{Surface::blendTexture}, std::vector{Surface::transmission},
                    std::vector{Surface::glass},
                    std::vector{Surface::opaque, Surface::maskSmooth, Surface::blendTexture,
                                Surface::transmission, Surface::glass}));

TEST(PointsTest, AnyResolutionAndDensityEqualsTheTwin) {
    const auto scene = texturedScene(7, 25, {Surface::opaque});
    for (const int resolution : {64, 97, 333})
        for (const double density : {0.5, 1.0, 1.7}) {
            PointsSetup setup;
            setup.resolution = resolution;
            setup.density = density;
            expectSame(PointsRun(scene, setup), Cull::none, neverClosed, resolution / 2);
        }
}

TEST(PointsTest, TrianglesBelowAPixelAndAcrossTheWholeViewEqualTheTwin) {
    SceneBuilder builder;
    builder.material().doubleSided = true;
    builder.addSphere({0.5F, 1, 0}, 0.3F, 60, 90);
    builder.addQuad({-2, 0, 2}, {4, 0.3F, 0}, {0, 0, -4});
    expectSame(PointsRun(builder.scene(), {}), Cull::none, neverClosed, 9000);
    PointsSetup wide;
    wide.light = "rect:at=0,2.5,0;aim=0,0,0;up=0,0,1;size=2x0.5;fov=50";
    expectSame(PointsRun(builder.scene(), wide), Cull::none, neverClosed, 20000);
}

TEST(PointsTest, EveryCullingModeDropsTheFacesItNames) {
    SceneBuilder builder;
    builder.addSphere({0, 1.2F, 0}, 0.5F, 12, 17);                   // node 0: closed
    builder.addQuad({-1.6F, 0.5F, 0.2F}, {1, 0, 0}, {0, 0.4F, -1});  // node 1: faces up
    builder.addQuad({0.6F, 0.5F, -0.8F}, {1, 0, 0}, {0, 0, 1});      // node 2: faces down
    const auto mirror = glm::dmat4(glm::dvec4(-1, 0, 0, 0), glm::dvec4(0, 1, 0, 0),
                                   glm::dvec4(0, 0, 1, 0), glm::dvec4(0, 0, 0, 1));
    builder.addMesh({{-1.5F, 1, 0}, {-0.7F, 1, 0}, {-0.7F, 1.3F, 1}}, {0, 1, 2}, mirror);  // node 3
    const auto closed = [](int node) { return node == 0; };
    std::map<Cull, std::size_t> counts;
    for (const auto cull : {Cull::none, Cull::automatic, Cull::back, Cull::front}) {
        PointsSetup setup;
        setup.cull = cull;
        const PointsRun run(builder.scene(), setup);
        expectSame(run, cull, closed, 1000);
        counts[cull] = run.counters.points;
    }
    EXPECT_LT(counts[Cull::back], counts[Cull::automatic]);
    EXPECT_LT(counts[Cull::automatic], counts[Cull::none]);
    EXPECT_EQ(counts[Cull::back] + counts[Cull::front], counts[Cull::none]);
}

TEST(PointsTest, CastersAcrossTheNearPlaneAreCutAtASixteenthAndCountedBeforeIt) {
    SceneBuilder builder;
    builder.material().doubleSided = true;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    builder.addQuad({-0.4F, 0.5F, -0.4F}, {0.5F, 3.6F, 0.3F}, {0.3F, 0, 0.6F});  // past the light
    PointsSetup setup;
    setup.light = "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1;near=1";
    const PointsRun run(builder.scene(), setup);
    const auto twin =
        pointsReference(run.scene, run.pose, run.light, run.view, Cull::none, neverClosed);
    const auto near = static_cast<std::size_t>(
        std::count_if(twin.begin(), twin.end(), [](const auto& p) { return p.w > 1; }));
    EXPECT_GT(near, 300U);
    // Along the cut and the edges of a clipped triangle, rounding decides pixels
    EXPECT_NEAR(run.counters.nearPoints, static_cast<double>(near),
                0.02 * static_cast<double>(near));
    const auto result = compare(run, twin);
    EXPECT_LE(result.missing, twin.size() / 50);
    EXPECT_LE(result.wrong, twin.size() / 200);
}

TEST(PointsTest, MapsStraightFromFragmentsEqualTheTwinsPointsWarped) {
    PointsSetup setup;
    setup.resolution = 501;
    PointsRun run(texturedScene(8, 25, {Surface::opaque, Surface::maskNearest}), setup);
    const auto twin =
        pointsReference(run.scene, run.pose, run.light, run.view, Cull::none, neverClosed);
    std::vector<WarpPoint> points;
    for (const auto& p : twin) points.push_back({p.a, p.b, p.w});
    const auto buffered = run.counters.points;
    const auto maps = run.directMaps();
    EXPECT_EQ(run.counters.points, buffered);
    ASSERT_EQ(maps.size(), 4U);
    for (std::size_t v = 0; v < maps.size(); ++v) {
        const auto expected = warpPoints(points, run.view.samples[2 * v],
                                         run.view.samples[2 * v + 1], run.view.params.resolution);
        std::size_t filled = 0, different = 0;
        for (std::size_t i = 0; i < expected.size(); ++i) {
            filled += expected[i] > 0;
            different += std::abs(maps[v][i] - expected[i]) > 2e-3;
        }
        EXPECT_GT(filled, 5000U);
        // Points that snapping moved over a texel's border, and pixels along edges
        EXPECT_LT(different, filled / 100) << "view " << v;
    }
}

}  // namespace
}  // namespace penumbra::tests
