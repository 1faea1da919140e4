// SPDX-License-Identifier: MIT
// Soft shadows that are known on paper: what binary visibility allows the exact techniques.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/reference/analytic_scenes.h"
#include "tests/reference/light_share.h"

namespace penumbra::tests {
namespace {

/// Technique, samples, limits of the mean over the penumbra and of the largest error, in 1/255.
struct Limit {
    const char *technique, *samples;
    double mean, largest;
};

void PrintTo(const Limit& limit, std::ostream* out) {
    *out << limit.technique << ' ' << limit.samples;
}

/// N samples are N steps: a row of a 16 x 16 grid is 8 of 255 to either side of an edge along it.
class AnalyticTest : public testing::TestWithParam<Limit> {};

TEST_P(AnalyticTest, HalfPlanesAtAllAnglesAreAsNearAsBinaryVisibilityComes) {
    const auto& limit = GetParam();
    const auto error = measureAnalytic(halfPlanes(), limit.technique, limit.samples);
    std::printf("[ ANALYTIC ] %s, %s samples: mean %.2f, largest %.1f, bias %+.2f of 255\n",
                limit.technique, limit.samples, 255 * error.mean, 255 * error.largest,
                255 * error.bias);
    EXPECT_GT(error.penumbra, 10000U);
    EXPECT_LT(255 * error.mean, limit.mean);
    EXPECT_LT(255 * error.largest, limit.largest);
    EXPECT_LT(255 * std::abs(error.bias), 0.05);
}

INSTANTIATE_TEST_SUITE_P(
    Exact, AnalyticTest,
    testing::Values(Limit{"raytrace", "256", 1.25, 8.2}, Limit{"raytrace", "16x16", 1.25, 8.2},
                    Limit{"raytrace", "1024", 0.6, 4.1}, Limit{"raytrace", "32x32", 0.6, 4.1},
                    Limit{"raster4d", "256", 1.25, 8.2}, Limit{"raster4d", "16x16", 1.25, 8.2},
                    Limit{"raster4d", "1024", 0.6, 4.1}, Limit{"raster4d", "32x32", 0.6, 4.1}));

TEST(AnalyticFormsTest, PolygonsAreClippedToTheirCommonArea) {
    const Polygon square = {{0, 0}, {0, 2}, {2, 2}, {2, 0}};  // clockwise
    EXPECT_DOUBLE_EQ(area(square), 4);
    EXPECT_DOUBLE_EQ(area(clipped(square, {1, 1}, 2)), 2);
    EXPECT_DOUBLE_EQ(area(clipped(square, {1, 0}, 3)), 0);
    const auto hull = convexHull({{1, 1}, {3, 1}, {2, 2}, {3, 3}, {1, 3}, {2, 1}});
    EXPECT_EQ(hull.size(), 4U);
    EXPECT_DOUBLE_EQ(area(hull), 4);
    EXPECT_DOUBLE_EQ(commonArea(square, hull), 1);
}

TEST(AnalyticFormsTest, ASphereOnTheAxisHidesADiskOfKnownRadius) {
    // Tangents from 2 m below a sphere of 0.5 m meet the plane 4 m up at 4 tan(asin(0.25))
    const double shadow = 4 * 0.25 / std::sqrt(1 - 0.25 * 0.25);
    EXPECT_NEAR(diskBesideSphere({0, 0, 0}, 2, 4, {0, 2, 0}, 0.5), 1 - shadow * shadow / 4, 5e-6);
    // Half a turn of everything about the axis, and a disk that is hidden altogether
    EXPECT_NEAR(diskBesideSphere({0.3, 0, 0.1}, 0.5, 4, {0.2, 2, -0.1}, 0.2),
                diskBesideSphere({-0.3, 0, -0.1}, 0.5, 4, {-0.2, 2, 0.1}, 0.2), 1e-12);
    EXPECT_NEAR(diskBesideSphere({0, 0, 0}, 1, 4, {0, 2, 0}, 0.5), 0, 1e-9);
    // A quarter turn exchanges chords and what the chords are added up along
    EXPECT_NEAR(diskBesideSphere({0.3, 0, 0.1}, 0.5, 4, {0.2, 2, -0.1}, 0.2),
                diskBesideSphere({-0.1, 0, 0.3}, 0.5, 4, {0.1, 2, 0.2}, 0.2), 1e-5);
}

TEST(AnalyticSceneTest, RaysAndMasksComeNearToEveryClosedForm) {
    const struct {
        AnalyticScene scene;
        const char* samples;
        double mean, largest;  ///< measured 0.26 and 1.3, 0.16 and 1.0, 0.4 and 2, of 255
    } cases[] = {{sphereUnderDisk(), "36x36", 0.4, 2},
                 {boxUnderRectangle(), "1024", 0.3, 1.5},
                 {halfPlanesInSeries(), "1024", 0.6, 3}};
    for (const char* technique : {"raytrace", "raster4d"})
        for (const auto& c : cases) {
            const auto error = measureAnalytic({c.scene}, technique, c.samples);
            EXPECT_GT(error.penumbra, 300U) << c.scene.name;
            EXPECT_LT(255 * error.mean, c.mean) << technique << ", " << c.scene.name;
            EXPECT_LT(255 * error.largest, c.largest) << technique << ", " << c.scene.name;
        }
}

TEST(AnalyticSceneTest, SheetsInSeriesLetTheProductThroughTheMoreSamplesThereAre) {
    // A sheet blocks its share of the samples; how those of several fall together is chance
    const auto scene = sheetsInSeries();
    EXPECT_LT(255 * measureAnalytic({scene}, "raytrace", "64").largest, 0.05);
    for (const auto& [samples, limit] : {std::pair("64", 30.0), {"256", 10.0}, {"1024", 5.0}})
        EXPECT_LT(255 * measureAnalytic({scene}, "raster4d", samples).largest, limit) << samples;
    EXPECT_EQ(measureAnalytic({scene}, "vwss", "64").largest,
              measureAnalytic({scene}, "raster4d", "64").largest);
}

}  // namespace
}  // namespace penumbra::tests
