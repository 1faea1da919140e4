// SPDX-License-Identifier: MIT
// What storing points as halves or in fixed point costs, against the same points as floats.
#include <cmath>
#include <cstdio>
#include <unordered_map>

#include "tests/reference/points_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using visibility::Precision;

constexpr int kResolution = 1024;

/// One tilted sheet that fills the enlarged view, so that points lie at every distance from the
/// centre and no two share a texel's place.
PointsRun sheet(Precision precision, double density) {
    SceneBuilder builder;
    builder.material().doubleSided = true;
    builder.addQuad({-8, 0, 8}, {16, 0.8F, 0}, {0, 0.5F, -16});
    PointsSetup setup;
    setup.light = "rect:at=0,6,0;aim=0,0,0;up=0,0,1;size=1x1;fov=60;near=4;radiance=10";
    setup.resolution = kResolution;
    setup.density = density;
    setup.precision = precision;
    return PointsRun(builder.scene(), setup);
}

/// A stored point and the float point that it stands for.
struct Pair {
    DevicePoint exact, stored;
};

/// Pairs each stored point with the nearest float point; fails unless every one is used once, which
/// holds where errors are below half of the points' spacing.
std::vector<Pair> paired(const PointsRun& exact, const PointsRun& stored) {
    const auto floats = exact.points();
    const auto key = [](double a, double b) {
        return static_cast<std::int64_t>(std::floor(a)) * 100000 +
               static_cast<std::int64_t>(std::floor(b));
    };
    std::unordered_multimap<std::int64_t, std::size_t> cells;
    for (std::size_t i = 0; i < floats.size(); ++i) cells.emplace(key(floats[i].a, floats[i].b), i);
    std::vector<bool> used(floats.size(), false);
    std::vector<Pair> pairs;
    std::size_t twice = 0;
    for (const auto& p : stored.points()) {
        double nearest = 1e9;
        std::size_t best = 0;
        for (int dx = -1; dx < 2; ++dx)
            for (int dy = -1; dy < 2; ++dy) {
                const auto [begin, end] = cells.equal_range(key(p.a + dx, p.b + dy));
                for (auto at = begin; at != end; ++at) {
                    const auto& f = floats[at->second];
                    const double d = std::hypot(p.a - f.a, p.b - f.b);
                    if (d < nearest) nearest = d, best = at->second;
                }
            }
        twice += nearest > 1e8 || used[best];
        used[best] = true;
        pairs.push_back({floats[best], p});
    }
    EXPECT_EQ(twice, 0U);
    EXPECT_EQ(pairs.size(), floats.size());
    return pairs;
}

TEST(PointsPrecisionTest, HalvesAreOffByLessThanTheirLastBitOfTheDistanceToTheCentre) {
    double rim = 0, depth = 0, relative = 0;
    for (const auto& [exact, stored] :
         paired(sheet(Precision::single, 1), sheet(Precision::half, 1))) {
        for (const auto& [is, was] : {std::pair(stored.a, exact.a), std::pair(stored.b, exact.b)}) {
            const double distance = std::abs(was - kResolution / 2);
            // Half of the last of 11 bits; below 2^-14 halves are evenly spaced. Floats lose 2^-15
            // where the centre is added
            ASSERT_LE(std::abs(is - was),
                      std::ldexp(std::max(distance, std::ldexp(1.0, -14)), -11) + 3.1e-5)
                << was;
            if (distance > 1) relative = std::max(relative, std::abs(is - was) / distance);
            if (distance <= kResolution / 2) rim = std::max(rim, std::abs(is - was));
        }
        ASSERT_LE(std::abs(stored.w - exact.w), std::ldexp(exact.w, -11));
        depth = std::max(depth, std::abs(stored.w - exact.w) / exact.w);
    }
    std::printf(
        "[ HALF     ] worst %.4f texels within the map, 2^%.2f of the distance, 2^%.2f of depth\n",
        rim, std::log2(relative), std::log2(depth));
    // Within the map distances are below 512: the last bit there is a quarter texel
    EXPECT_LE(rim, 0.12504);
    EXPECT_GT(rim, 0.12);  // and the bound is no idle one
    EXPECT_GT(relative, 0.99 * std::ldexp(1.0, -11));
}

TEST(PointsPrecisionTest, FixedPointIsOffByHalfOfAStepAtAnyDensity) {
    for (const double density : {1.0, 0.6, 2.0}) {
        const auto exact = sheet(Precision::single, density);
        const auto& v = exact.view.params;
        // The light's views together span resolution (1 + back / near) texels
        const double step = kResolution * (1 + static_cast<double>(v.setBack) / v.near) / 65535;
        double worst = 0, depth = 0;
        for (const auto& [was, is] : paired(exact, sheet(Precision::fixed, density))) {
            worst = std::max({worst, std::abs(is.a - was.a), std::abs(is.b - was.b)});
            depth = std::max(depth, std::abs(is.w - was.w));
        }
        std::printf("[ FIXED    ] density %.1f: worst %.4f texels, step %.4f; depth 2^%.2f\n",
                    density, worst, step, std::log2(depth));
        // Half a step and the rounding of floats of up to 1024 (2^-14)
        EXPECT_LE(worst, 0.5 * step + 1.5e-4);
        EXPECT_GT(worst, 0.4 * step);
        EXPECT_LE(depth, 0.5 / 65535 + 1e-7);
    }
}

}  // namespace
}  // namespace penumbra::tests
