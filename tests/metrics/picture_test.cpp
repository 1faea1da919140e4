// SPDX-License-Identifier: MIT
#include "host/metrics/picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/image/srgb.h"
#include "host/image/tone_map.h"
#include "host/metrics/image_error.h"
#include "runtime/error.h"

namespace penumbra::tests {
namespace {

using image::LoadedImage;
using metrics::Encoding;
using metrics::pictureOf;

LoadedImage linearImage(const std::vector<Channel>& channels, const std::string& gain = "") {
    LoadedImage image;
    image.width = static_cast<int>(channels[0].values.size());
    image.height = 1;
    image.channels = channels;
    if (!gain.empty()) image.header = {{"penumbra.gain", gain}};
    return image;
}

TEST(PictureTest, LinearColoursAreShownAsPngFilesShowThem) {
    // Dark, middling, beyond the knee of the tone curve, half covered, negative
    Frame frame;
    frame.width = 5;
    frame.height = 1;
    frame.exposure = 0.5;
    frame.rgba = {0.01F, 0.02F, 0,    1,    0.4F, 0.3F, 0.2F, 1,    9,     2,
                  1,     1,     0.2F, 0.1F, 0.3F, 0.5F, -1,   0.5F, 0.25F, 1};
    std::vector<Channel> channels;
    const char* names[] = {"R", "G", "B", "A"};
    for (std::size_t c = 0; c < 4; ++c) {
        channels.push_back({names[c], {}, {}});
        for (std::size_t i = 0; i < 5; ++i) channels[c].values.push_back(frame.rgba[4 * i + c]);
    }
    const auto picture = pictureOf(linearImage(channels), "RGB", 0.5F);
    ASSERT_TRUE(picture);
    EXPECT_EQ(picture->encoding, Encoding::srgb);
    const auto bytes = image::toneMap(frame);
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(255 * picture->planes[c][i], bytes[3 * i + c], 0.6F) << i << ", " << c;
    // By hand: 0.4 at a gain of 0.5, less the 4 % that the tone curve takes off, is sRGB(0.16)
    EXPECT_NEAR(picture->planes[0][1], 0.437, 0.001);
}

TEST(PictureTest, EncodedColoursStayAsTheyAre) {
    auto image = linearImage({{"R", {0.25F}, {}}, {"G", {0.5F}, {}}, {"B", {1}, {}}});
    image.srgb = true;
    const auto picture = pictureOf(image, "RGB", 4);
    EXPECT_EQ(picture->planes, (std::vector<metrics::Plane>{{0.25F}, {0.5F}, {1}}));
    EXPECT_EQ(picture->encoding, Encoding::srgb);
}

TEST(PictureTest, VisibilityAndAlbedoStayAsTheyAre) {
    const auto image = linearImage({{"visibility.key.R", {0.3F}, {}},
                                    {"visibility.sky.R", {0.1F}, {}},
                                    {"visibility.sky.G", {0.2F}, {}},
                                    {"visibility.sky.B", {0.3F}, {}},
                                    {"albedo.R", {0.4F}, {}},
                                    {"albedo.G", {0.5F}, {}},
                                    {"albedo.B", {0.6F}, {}}});
    const auto key = pictureOf(image, "visibility.key", 4);
    EXPECT_EQ(key->planes, (std::vector<metrics::Plane>{{0.3F}}));
    EXPECT_EQ(key->encoding, Encoding::linear);
    const auto sky = pictureOf(image, "visibility.sky", 4);
    EXPECT_EQ(sky->planes, (std::vector<metrics::Plane>{{0.1F}, {0.2F}, {0.3F}}));
    const auto albedo = pictureOf(image, "albedo", 4);
    ASSERT_TRUE(albedo);
    EXPECT_EQ(albedo->planes, (std::vector<metrics::Plane>{{0.4F}, {0.5F}, {0.6F}}));
    EXPECT_EQ(albedo->encoding, Encoding::linear);
}

TEST(PictureTest, DepthNormalsAndIdsAreNoPictures) {
    const auto image = linearImage({{"Z", {3}, {}},
                                    {"N.X", {1}, {}},
                                    {"id.object", {1}, {}},
                                    {"unknown.R", {1}, {}},
                                    {"unknown.G", {1}, {}},
                                    {"unknown.B", {1}, {}}});
    for (const char* layer : {"Z", "N", "id", "unknown", "RGB", "visibility.key"})
        EXPECT_FALSE(pictureOf(image, layer, 1)) << layer;
}

TEST(PictureTest, TheGainIsThatOfTheFirstImageWhichHasOne) {
    const Channel red{"R", {1}, {}};
    const auto none = linearImage({red}), two = linearImage({red}, "2"),
               four = linearImage({red}, "4");
    EXPECT_EQ(metrics::commonGain(none, none), 1);
    EXPECT_EQ(metrics::commonGain(two, four), 2);
    EXPECT_EQ(metrics::commonGain(none, four), 4);
    for (const char* gain : {"bright", "0", "-1", "inf"})
        EXPECT_THROW(metrics::commonGain(linearImage({red}, gain), none), Error) << gain;
}

TEST(PictureTest, AColourWithANotANumberIsOneAndInfinityIsWhite) {
    const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
    for (std::size_t broken = 0; broken < 3; ++broken) {
        std::vector<Channel> channels;
        for (const char* name : {"R", "G", "B"}) channels.push_back({name, {0, infinity}, {}});
        channels[broken].values[0] = nan;
        const auto picture = pictureOf(linearImage(channels), "RGB", 1);
        for (const auto& plane : picture->planes) {
            EXPECT_TRUE(std::isnan(plane[0])) << broken;
            EXPECT_NEAR(plane[1], 1, 1e-3);
        }
    }
}

TEST(PictureTest, SrgbIsDecodedToWhatWasEncoded) {
    for (int i = 0; i <= 1000; ++i) {
        const double v = i / 1000.0;
        ASSERT_NEAR(image::linearFromSrgb(image::srgbFromLinear(v)), v, 1e-6);
    }
    EXPECT_NEAR(image::srgbFromLinear(0.214041), 0.5, 1e-5);
    EXPECT_NEAR(image::srgbFromLinear(0.002), 0.02584, 1e-9);
}

TEST(PictureTest, SeveralLayersHaveTheMeanOfTheirFigures) {
    const auto a =
        linearImage({{"visibility.x.R", {0.5F, 0.5F}, {}}, {"visibility.y.R", {0, 0}, {}}});
    const auto b =
        linearImage({{"visibility.x.R", {0.5F, 0.5F}, {}}, {"visibility.y.R", {1, 1}, {}}});
    const auto errors = metrics::compareImages(a, b, "", {});
    ASSERT_EQ(errors.size(), 3U);
    EXPECT_EQ(errors[1].flip, 0);
    EXPECT_GT(*errors[2].flip, 0.9);
    EXPECT_NEAR(*errors[0].flip, *errors[2].flip / 2, 1e-12);
    EXPECT_NEAR(*errors[0].ssim, (1 + *errors[2].ssim) / 2, 1e-12);
}

TEST(PictureTest, BackgroundAndWhatTheMaskLeavesOutDoNotCount) {
    // The last pixels lie beyond the reach of what differs
    std::vector<float> shadow(80, 0.5F), other(80, 0.5F), covered(80, 1);
    std::vector<bool> mask(80, true);
    for (std::size_t i = 0; i < 20; ++i) {
        other[i] = 1;
        if (i < 10) covered[i] = 0;
        mask[i] = false;
    }
    for (std::size_t i = 20; i < 40; ++i) mask[i] = false;
    const auto a = linearImage({{"visibility.x.R", shadow, {}}, {"A", covered, {}}});
    const auto b = linearImage({{"visibility.x.R", other, {}}, {"A", covered, {}}});
    const auto masked = metrics::compareImages(a, b, "", mask)[0];
    EXPECT_EQ(masked.flip, 0);
    EXPECT_EQ(masked.ssim, 1);
    const auto seen = metrics::compareImages(a, b, "", {})[0];
    auto opaque = a;
    opaque.channels.pop_back();
    const auto all = metrics::compareImages(opaque, b, "", {})[0];
    EXPECT_LT(*seen.flip, *all.flip);
    EXPECT_GT(*seen.ssim, *all.ssim);
}

}  // namespace
}  // namespace penumbra::tests
