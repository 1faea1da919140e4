// SPDX-License-Identifier: MIT
#include "host/metrics/ssim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runtime/error.h"
#include "tests/metrics/pictures.h"
#include "tests/reference/ssim_ref.h"

namespace penumbra::tests {
namespace {

using metrics::Encoding;
using metrics::Picture;
using metrics::ssim;

TEST(SsimTest, EqualPicturesHaveExactlyOneEverywhere) {
    const auto picture = noise(31, 17, 3, 5);
    const auto result = ssim(picture, picture);
    EXPECT_EQ(result.mean, 1);
    for (const float value : result.map) ASSERT_EQ(value, 1);
}

TEST(SsimTest, BlackAgainstWhiteHasWhatTheDefinitionGives) {
    // Variances are 0, so that only the term of the means is left: C1 / (1 + C1)
    const auto result = ssim(uniform(20, 12, {0}), uniform(20, 12, {1}));
    EXPECT_NEAR(result.mean, 1e-4 / 1.0001, 1e-7);
}

TEST(SsimTest, ANegativeIsBelowZero) {
    const auto picture = noise(40, 30, 1, 3);
    auto negative = picture;
    for (float& value : negative.planes[0]) value = 1 - value;
    EXPECT_LT(ssim(picture, negative).mean, -0.8);
}

TEST(SsimTest, ExchangingThePicturesChangesNothing) {
    const auto a = still(40, 30), b = withNoise(a, 0.3F);
    EXPECT_EQ(ssim(a, b).map, ssim(b, a).map);
}

TEST(SsimTest, MoreNoiseIsLessSimilar) {
    const auto picture = still(64, 48);
    double last = 1;
    for (const float amount : {0.02F, 0.05F, 0.1F, 0.2F, 0.4F}) {
        const double value = ssim(picture, withNoise(picture, amount)).mean;
        EXPECT_LT(value, last - 0.01) << "noise of " << amount;
        last = value;
    }
}

TEST(SsimTest, StructureCountsMoreThanAShiftOfTheLevel) {
    // Both differ from the picture by a root mean square of 0.1
    const auto picture = still(64, 48);
    auto shifted = picture;
    for (auto& plane : shifted.planes)
        for (float& value : plane) value += 0.1F;
    EXPECT_GT(ssim(picture, shifted).mean,
              ssim(picture, withNoise(picture, 0.1F * std::sqrt(12.0F))).mean + 0.3);
}

TEST(SsimTest, OnlyPixelsOfTheMaskAreAveraged) {
    // They differ on the left; windows reach 5 pixels
    const auto a = uniform(40, 10, {0.5F});
    auto b = a;
    for (std::size_t i = 0; i < b.planes[0].size(); ++i)
        if (i % 40 < 10) b.planes[0][i] = 0;
    std::vector<bool> right(400), left(400), none(400);
    for (std::size_t i = 0; i < 400; ++i) {
        right[i] = i % 40 >= 15;
        left[i] = i % 40 < 5;
    }
    EXPECT_EQ(ssim(a, b, right).mean, 1);
    EXPECT_LT(ssim(a, b, left).mean, 0.01);
    EXPECT_EQ(ssim(a, b, none).mean, 1);
    EXPECT_LT(ssim(a, b).mean, 1);
}

TEST(SsimTest, ColoursAreWeighedAsLuminance) {
    const auto black = uniform(12, 12, {0, 0, 0});
    const double expected[] = {0.2126, 0.7152, 0.0722};
    for (std::size_t c = 0; c < 3; ++c) {
        std::vector<float> colour(3, 0);
        colour[c] = 1;
        const double square = expected[c] * expected[c];
        EXPECT_NEAR(ssim(black, uniform(12, 12, colour)).mean, 1e-4 / (square + 1e-4), 1e-5);
    }
}

class SsimReferenceTest : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(SsimReferenceTest, MapsMatchTheTwinThatFollowsTheDefinition) {
    const auto [width, height] = GetParam();
    for (unsigned seed = 0; seed < 4; ++seed) {
        const auto a = noise(width, height, 1, 2 * seed, Encoding::linear);
        // Unrelated pictures, and ones that are nearly the same
        auto b = noise(width, height, 1, 2 * seed + 1, Encoding::linear);
        if (seed % 2 == 1)
            for (std::size_t i = 0; i < b.planes[0].size(); ++i)
                b.planes[0][i] = 0.9F * a.planes[0][i] + 0.1F * b.planes[0][i];
        const auto map = ssim(a, b).map;
        const auto& pa = a.planes[0];
        const auto& pb = b.planes[0];
        const auto expected =
            ssimMap({pa.begin(), pa.end()}, {pb.begin(), pb.end()}, width, height);
        ASSERT_EQ(map.size(), expected.size());
        for (std::size_t i = 0; i < map.size(); ++i)
            ASSERT_NEAR(static_cast<double>(map[i]), expected[i], 2e-5) << "pixel " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SsimReferenceTest,
                         testing::Values(std::pair{1, 1}, std::pair{7, 5}, std::pair{1, 30},
                                         std::pair{64, 48}));

TEST(SsimTest, SmoothBrightPicturesKeepTheirDigits) {
    // Variances far below the squares of the means, where float could lose them
    auto a = uniform(32, 24, {0}, Encoding::linear), b = a;
    for (std::size_t i = 0; i < a.planes[0].size(); ++i) {
        a.planes[0][i] = 0.97F + 0.0005F * static_cast<float>(i % 32);
        b.planes[0][i] = 0.97F + 0.0005F * static_cast<float>((i / 32) % 24);
    }
    const auto map = ssim(a, b).map;
    const auto expected = ssimMap({a.planes[0].begin(), a.planes[0].end()},
                                  {b.planes[0].begin(), b.planes[0].end()}, 32, 24);
    for (std::size_t i = 0; i < map.size(); ++i)
        ASSERT_NEAR(static_cast<double>(map[i]), expected[i], 1e-3) << "pixel " << i;
}

TEST(SsimTest, NotANumberNeverPassesForAgreement) {
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    const auto one = [](float a, float b) {
        return ssim(uniform(1, 1, {a}), uniform(1, 1, {b})).mean;
    };
    EXPECT_LT(one(0.0F, nan), 0.01);
    EXPECT_LT(one(nan, 1.0F), 0.01);
    EXPECT_EQ(one(nan, nan), 1);
    EXPECT_EQ(one(infinity, 1.0F), 1);
    EXPECT_EQ(one(-infinity, 0.0F), 1);
}

TEST(SsimTest, PicturesThatDoNotFitAreRefused) {
    const auto a = uniform(4, 3, {0.5F});
    EXPECT_THROW(ssim(a, uniform(3, 4, {0.5F})), Error);
    EXPECT_THROW(ssim(a, uniform(4, 3, {0.5F, 0.5F, 0.5F})), Error);
    EXPECT_THROW(ssim(a, uniform(4, 3, {0.5F}, Encoding::linear)), Error);
    EXPECT_THROW(ssim(uniform(4, 3, {0, 0}), uniform(4, 3, {0, 0})), Error);
    EXPECT_THROW(ssim(a, a, std::vector<bool>(5)), Error);
    EXPECT_THROW(ssim(uniform(0, 0, {0}), uniform(0, 0, {0})), Error);
}

}  // namespace
}  // namespace penumbra::tests
