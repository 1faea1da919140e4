// SPDX-License-Identifier: MIT
#include "host/metrics/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/image/srgb.h"
#include "runtime/error.h"
#include "tests/metrics/pictures.h"
#include "tests/reference/flip_ref.h"

namespace penumbra::tests {
namespace {

using metrics::Encoding;
using metrics::flip;
using metrics::Picture;

std::vector<Rgb> pixelsOf(const Picture& picture) {
    std::vector<Rgb> pixels(picture.planes[0].size());
    for (std::size_t i = 0; i < pixels.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            pixels[i][c] = static_cast<double>(picture.planes[c][i]);
    return pixels;
}

TEST(FlipTest, EqualPicturesDifferNowhere) {
    const auto picture = noise(31, 17, 3, 5);
    const auto result = flip(picture, picture);
    EXPECT_EQ(result.mean, 0);
    for (const float value : result.map) ASSERT_EQ(value, 0);
}

TEST(FlipTest, BlackAgainstWhiteHasWhatThePaperGives) {
    // HyAB is 100 and there are no features; green to blue, the largest, is 203.32 after Hunt
    const double most = std::pow(203.32, 0.7), knee = 0.4 * most;
    const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - knee) / (most - knee);
    EXPECT_NEAR(flip(uniform(30, 20, {0, 0, 0}), uniform(30, 20, {1, 1, 1})).mean, expected, 1e-4);
}

TEST(FlipTest, GreenAgainstBlueIsTheLargestDifference) {
    EXPECT_NEAR(flip(uniform(30, 20, {0, 1, 0}), uniform(30, 20, {0, 0, 1})).mean, 1, 1e-5);
}

TEST(FlipTest, ExchangingThePicturesChangesNothing) {
    const auto a = still(40, 30), b = withNoise(a, 0.3F);
    EXPECT_EQ(flip(a, b).map, flip(b, a).map);
}

TEST(FlipTest, MoreNoiseIsMoreDifferent) {
    const auto picture = still(64, 48);
    double last = 0;
    for (const float amount : {0.02F, 0.05F, 0.1F, 0.2F, 0.4F}) {
        const double value = flip(picture, withNoise(picture, amount)).mean;
        EXPECT_GT(value, last + 0.01) << "noise of " << amount;
        last = value;
    }
}

TEST(FlipTest, AnEdgeThatMovesIsMoreThanItsColours) {
    // What the features add: the same difference of colours is raised where an edge appears
    const auto flat = uniform(64, 32, {0.5F, 0.5F, 0.5F});
    auto step = flat;
    for (auto& plane : step.planes)
        for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = i % 64 < 32 ? 0.3F : 0.7F;
    const auto map = flip(flat, step).map;
    const auto row = map.begin() + 16 * 64;
    EXPECT_GT(row[36], row[60] + 0.1F);
}

TEST(FlipTest, FineDetailIsSeenLessFromAfar) {
    const auto picture = still(64, 48), grainy = withNoise(picture, 0.2F);
    EXPECT_GT(flip(picture, grainy, {}, {20}).mean, flip(picture, grainy, {}, {67}).mean + 0.02);
    EXPECT_GT(flip(picture, grainy, {}, {67}).mean, flip(picture, grainy, {}, {200}).mean + 0.02);
}

TEST(FlipTest, OnlyPixelsOfTheMaskAreAveraged) {
    // They differ on the left; filters reach 10 pixels
    const auto a = uniform(60, 8, {0.5F, 0.5F, 0.5F});
    auto b = a;
    for (std::size_t i = 0; i < 480; ++i)
        if (i % 60 < 10) b.planes[1][i] = 0;
    std::vector<bool> right(480), left(480), none(480);
    for (std::size_t i = 0; i < 480; ++i) {
        right[i] = i % 60 >= 20;
        left[i] = i % 60 < 5;
    }
    EXPECT_EQ(flip(a, b, right).mean, 0);
    EXPECT_GT(flip(a, b, left).mean, 0.5);
    EXPECT_EQ(flip(a, b, none).mean, 0);
    EXPECT_GT(flip(a, b).mean, 0);
}

TEST(FlipTest, LinearPicturesAreThoseThatEncodingWouldShow) {
    const auto a = noise(24, 18, 1, 7, Encoding::linear), b = noise(24, 18, 1, 8, Encoding::linear);
    const auto shown = [](const Picture& linear) {
        auto picture = uniform(linear.width, linear.height, {0, 0, 0});
        for (auto& plane : picture.planes)
            for (std::size_t i = 0; i < plane.size(); ++i)
                plane[i] = image::srgbFromLinear(linear.planes[0][i]);
        return picture;
    };
    const auto map = flip(a, b).map, expected = flip(shown(a), shown(b)).map;
    for (std::size_t i = 0; i < map.size(); ++i) ASSERT_NEAR(map[i], expected[i], 1e-4F);
}

struct Case {
    int width, height;
    double pixelsPerDegree;
};

class FlipReferenceTest : public testing::TestWithParam<Case> {};

TEST_P(FlipReferenceTest, MapsMatchTheTwinThatFollowsThePaper) {
    const auto [width, height, ppd] = GetParam();
    const auto check = [&, w = width, h = height, p = ppd](const Picture& a, const Picture& b) {
        const auto map = flip(a, b, {}, {p}).map;
        const auto expected = flipMap(pixelsOf(a), pixelsOf(b), w, h, p);
        ASSERT_EQ(map.size(), expected.size());
        for (std::size_t i = 0; i < map.size(); ++i)
            ASSERT_NEAR(static_cast<double>(map[i]), expected[i], 1e-4) << "pixel " << i;
    };
    for (unsigned seed = 0; seed < 2; ++seed)
        check(noise(width, height, 3, 2 * seed), noise(width, height, 3, 2 * seed + 1));
    // Dark and saturated colours, where the Hunt adjustment and the clamp to the cube act
    auto dark = still(width, height), red = dark;
    for (auto& plane : dark.planes)
        for (float& value : plane) value *= 0.2F;
    for (float& value : red.planes[0]) value = value > 0.4F ? 1.0F : 0.0F;
    check(still(width, height), dark);
    check(dark, red);
}

INSTANTIATE_TEST_SUITE_P(Sizes, FlipReferenceTest,
                         testing::Values(Case{1, 1, 67}, Case{7, 5, 67}, Case{1, 30, 67},
                                         Case{64, 48, 67}, Case{33, 20, 25}, Case{16, 12, 1}));

TEST(FlipTest, NotANumberNeverPassesForAgreement) {
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const auto one = [](float a, float b) {
        return flip(uniform(1, 1, {a}, Encoding::linear), uniform(1, 1, {b}, Encoding::linear))
            .mean;
    };
    EXPECT_GT(one(0.0F, nan), 0.9);
    EXPECT_GT(one(nan, 1.0F), 0.9);
    EXPECT_EQ(one(nan, nan), 0);
    EXPECT_EQ(one(infinity, 1.0F), 0);
    EXPECT_EQ(one(-infinity, 0.0F), 0);
}

TEST(FlipTest, PicturesAndSettingsThatDoNotFitAreRefused) {
    const auto a = uniform(4, 3, {0.5F});
    EXPECT_THROW(flip(a, uniform(3, 4, {0.5F})), Error);
    EXPECT_THROW(flip(a, uniform(4, 3, {0.5F, 0.5F, 0.5F})), Error);
    EXPECT_THROW(flip(a, uniform(4, 3, {0.5F}, Encoding::linear)), Error);
    EXPECT_THROW(flip(a, a, std::vector<bool>(5)), Error);
    for (const double ppd : {0.5, 1001.0, std::nan("")}) EXPECT_THROW(flip(a, a, {}, {ppd}), Error);
}

}  // namespace
}  // namespace penumbra::tests
