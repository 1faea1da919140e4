// SPDX-License-Identifier: MIT
// EXR and PNG files, tone map, metrics.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "host/image/image_file.h"
#include "host/image/tone_map.h"
#include "host/metrics/image_error.h"
#include "runtime/error.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

Frame gradient(int width, int height) {
    Frame frame;
    frame.width = width;
    frame.height = height;
    frame.fingerprint = "f00d";
    frame.header = {{"technique", "none"}};
    for (int i = 0; i < width * height; ++i)
        for (int c = 0; c < 4; ++c)
            frame.rgba.push_back(c == 3 ? 1.0F : static_cast<float>(i * (c + 1)) / 16);
    Channel depth{"Z", {}, {}}, ids{"id.object", {}, {}};
    for (int i = 0; i < width * height; ++i) {
        depth.values.push_back(i == 0 ? std::numeric_limits<float>::infinity()
                                      : 0.1F * static_cast<float>(i));
        ids.ids.push_back(static_cast<std::uint32_t>(i) + 70000U);
    }
    frame.channels = {depth, ids};
    return frame;
}

TEST(ExrTest, ChannelsAndHeaderComeBack) {
    const auto path = temporaryFolder("exr") + "/a.exr";
    const Frame frame = gradient(5, 3);
    writeExr(path, frame);
    const auto image = image::readImage(path);
    EXPECT_EQ(image.width, 5);
    EXPECT_EQ(image.height, 3);
    ASSERT_NE(image.find("G"), nullptr);
    EXPECT_EQ((*image.find("G"))[7], 7 * 2 / 16.0F);  // exact in half
    EXPECT_TRUE(std::isinf((*image.find("Z"))[0]));
    EXPECT_EQ((*image.find("Z"))[4], 0.1F * 4);  // float, not half
    EXPECT_EQ((*image.find("id.object"))[14], 70014.0F);
    EXPECT_EQ(readFingerprint(path), "f00d");
}

TEST(ExrTest, TheSameFrameIsTheSameFile) {
    const auto folder = temporaryFolder("exr-bytes");
    const auto bytes = [&](const std::string& name) {
        writeExr(folder + name, gradient(9, 7));
        std::ifstream file(folder + name, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    EXPECT_EQ(bytes("/a.exr"), bytes("/b.exr"));
}

TEST(ExrTest, DepthMapsLieBesideTheFrame) {
    const auto folder = temporaryFolder("exr-maps");
    Frame frame = gradient(2, 2);
    frame.depthMapSize = 2;
    frame.depthMaps = {{"key.0000", {0, 0.25F, 0.5F, 1}, {}}};
    writeExr(folder + "/frame_0001.exr", frame);
    const auto maps = image::readImage(folder + "/frame_0001.depth-maps.exr");
    EXPECT_EQ(*maps.find("key.0000"), (std::vector<float>{0, 0.25F, 0.5F, 1}));
}

TEST(PngTest, ColoursAreToneMappedSrgbAndTheFingerprintIsKept) {
    const auto path = temporaryFolder("png") + "/a.png";
    Frame frame = gradient(4, 1);
    frame.rgba = {0, 0, 0, 1, 0.2F, 0.2F, 0.2F, 1, 100, 100, 100, 1, 0, 0, 0, 0};
    writePng(path, frame);
    const auto image = image::readImage(path);
    const auto& red = *image.find("R");
    EXPECT_EQ(red[0], 0);
    // PBR Neutral takes the 4 % Fresnel offset off: sRGB(0.16) = 0.437
    EXPECT_NEAR(red[1], 0.437, 0.005);
    EXPECT_GT(red[2], 0.97);
    EXPECT_GT(red[3], 0);  // background is dark, not black
    EXPECT_EQ(readFingerprint(path), "f00d");
}

TEST(ImageFileTest, AFailedWriteLeavesNoPartialFile) {
    const auto folder = temporaryFolder("unwritable");
    EXPECT_THROW(writePng(folder + "/absent/a.png", gradient(2, 2)), Error);
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST(ImageFileTest, DamagedFilesHaveNoFingerprintAndNameThemselvesWhenRead) {
    const auto folder = temporaryFolder("damaged");
    for (const char* name : {"/a.exr", "/a.png"}) {
        const auto path = folder + name;
        if (path.ends_with("exr"))
            writeExr(path, gradient(64, 64));
        else
            writePng(path, gradient(64, 64));
        std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
        EXPECT_EQ(readFingerprint(path), "") << path;
        try {
            image::readImage(path);
            ADD_FAILURE() << path << " is read";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
        }
    }
}

using Plane = std::vector<float>;

TEST(ImageErrorTest, FiguresOfAKnownDifference) {
    const Plane a{0, 0, 0, 0}, b{0, 0.5F, 0, 0.01F};
    const auto e = metrics::imageError({&a}, {&b}, {});
    EXPECT_EQ(e.pixels, 4U);
    EXPECT_NEAR(e.rmse, std::sqrt((0.25 + 0.0001) / 4), 1e-7);
    EXPECT_NEAR(e.maximum, 0.5, 1e-7);
    EXPECT_NEAR(e.mean, 0.51 / 4, 1e-7);
    EXPECT_NEAR(e.psnr, -20 * std::log10(e.rmse), 1e-9);
    EXPECT_EQ(e.share[0], 0.5);   // both beyond 1/255
    EXPECT_EQ(e.share[1], 0.25);  // 0.01 < 4/255
    EXPECT_EQ(e.share[2], 0.25);
}

TEST(ImageErrorTest, AMaskLeavesPixelsOut) {
    const Plane a{0, 0}, b{0, 1};
    EXPECT_EQ(metrics::imageError({&a}, {&b}, {true, false}).maximum, 0);
    EXPECT_EQ(metrics::imageError({&a}, {&b}, {false, true}).rmse, 1);
}

TEST(ImageErrorTest, EqualInfinitiesAgreeAndNotANumberDiffers) {
    const float inf = std::numeric_limits<float>::infinity();
    const Plane a{inf, 1}, b{inf, std::nanf("")};
    const auto e = metrics::imageError({&a}, {&b}, {});
    EXPECT_EQ(e.share[2], 0.5);
    EXPECT_EQ(e.maximum, 1);
}

TEST(ImageErrorTest, VisibilityIsComparedWhereBothHaveIt) {
    image::LoadedImage a, b;
    a.width = b.width = 1;
    a.height = b.height = 1;
    a.channels = {{"R", {0}, {}}, {"visibility.key.R", {0.5F}, {}}};
    b.channels = {{"R", {1}, {}}, {"visibility.key.R", {0.25F}, {}}};
    EXPECT_EQ(metrics::compareImages(a, b, "", {})[0].error.maximum, 0.25);
    EXPECT_EQ(metrics::compareImages(a, b, "RGB", {})[0].error.maximum, 1);
    EXPECT_THROW(metrics::compareImages(a, b, "Z", {}), Error);
    b.width = 2;
    EXPECT_THROW(metrics::compareImages(a, b, "", {}), Error);
}

}  // namespace
}  // namespace penumbra::tests
