// SPDX-License-Identifier: MIT
// Files that must be refused before or while they are parsed, and what they refer to: each with its
// whole message.
#include <functional>

#include "tests/scene/gltf_test_file.h"
#include "tests/support/png_bytes.h"

namespace penumbra::scene {
namespace {

struct BadFile {
    const char* name;
    std::function<std::string()> bytes;
    const char* message;  ///< after the file's name
};

std::string triangleGlb() {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    return file.glb(GltfTestFile::meshOf(R"("attributes":{"POSITION":0})"));
}

std::function<std::string()> text(const std::string& bytes) {
    return [bytes] { return bytes; };
}

std::function<std::string()> json(const std::string& rest) {
    return text(R"({"asset":{"version":"2.0"},)" + rest + "}");
}

std::function<std::string()> buffer(const std::string& uri) {
    return json(R"("buffers":[{"byteLength":4,"uri":")" + uri + "\"}]");
}

/// A material that uses an image, given by its JSON.
std::string imageJson(const std::string& image) {
    return R"("images":[)" + image +
           R"(],"textures":[{"source":0}],"materials":[{"emissiveTexture":{"index":0}}])";
}

std::function<std::string()> imageAt(const std::string& uri) {
    return json(imageJson(R"({"uri":")" + uri + "\"}"));
}

std::function<std::string()> embedded(const std::string& bytes) {
    return [bytes] {
        GltfTestFile file;
        file.view(std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
        return file.glb(imageJson(R"({"bufferView":0})"));
    };
}

#define REFERS_OUTSIDE(uri)    \
    "refers to the file '" uri \
    "'; only relative paths to regular files inside of the scene's folder are read"

const BadFile kBadFiles[] = {
    // Cut off
    {"Empty", text(""), "'DIR/scene.gltf' has 0 bytes; allowed are 1 to 2147483647"},
    {"HeaderAlone", [] { return triangleGlb().substr(0, 12); },
     "is a .glb of 12 bytes; its headers alone take 20"},
    {"CutInTheJson", [] { return triangleGlb().substr(0, 60); },
     "is a .glb that claims 336 bytes but has 60"},
    {"CutInTheData", [] { return triangleGlb().substr(0, triangleGlb().size() - 8); },
     "is a .glb that claims 336 bytes but has 328"},
    {"TextCutOff", text(R"({"asset":{"version":"2.0"},"nodes":[{"name")"),
     "is not valid: [json.exception.parse_error.101] parse error at line 1, column 44: "
     "syntax error while parsing object separator - unexpected end of input; expected "
     "':'"},
    // Something else
    {"NoJson", text("hello, world"),
     "is not valid: [json.exception.parse_error.101] parse error at line 1, column 1: "
     "syntax error while parsing value - invalid literal; last read: 'h'"},
    {"AnArray", text("[1, 2]"), "the JSON is an array; an object is needed"},
    {"NoAsset", text(R"({"nodes":[]})"),
     R"(is not valid: "asset" object not found in .gltf or not an object type)"},
    {"OldVersion", text(R"({"asset":{"version":"1.0"}})"), "is glTF 1.0; only 2.0 is supported"},
    {"NestedDeeply", [] { return R"({"extras":)" + std::string(1000, '['); },
     "the JSON nests deeper than 128 levels"},
    // Buffers
    {"BufferAbsent", buffer("absent.bin"), "is not valid: File not found : absent.bin"},
    {"BufferIsAFolder", buffer("folder"), REFERS_OUTSIDE("folder")},
    {"BufferTooShort", buffer("short.bin"),
     "is not valid: File size mismatch : short.bin, requestedBytes 4, but got 3"},
    {"BufferIsEmpty", buffer("empty.bin"),
     "'DIR/empty.bin' has 0 bytes; allowed are 1 to 2147483647"},
    {"BufferIsADevice", buffer("/dev/zero"), REFERS_OUTSIDE("/dev/zero")},
    {"BufferIsALinkToADevice", buffer("zero"), REFERS_OUTSIDE("zero")},
    {"BufferAbove", buffer("../a.bin"), REFERS_OUTSIDE("../a.bin")},
    {"BufferAboveByEscapes", buffer("%2e%2e/a.bin"), REFERS_OUTSIDE("../a.bin")},
    {"BufferBehindALink", buffer("up/a.bin"), REFERS_OUTSIDE("up/a.bin")},
    {"BufferOnTheNet", buffer("http://example.com/a.bin"),
     REFERS_OUTSIDE("http://example.com/a.bin")},
    {"BufferOfNoBase64", buffer("data:application/octet-stream;base64,@@@"),
     "is not valid: Failed to decode 'uri' : data:application/octet-stream;base64,@@@ "
     "in Buffer"},
    // Images
    {"ImageAbsent", imageAt("absent.png"), "image 0 ('absent.png') was not found or is empty"},
    {"ImageIsAFolder", imageAt("folder"), REFERS_OUTSIDE("folder")},
    {"ImageAbove", imageAt("../a.png"), REFERS_OUTSIDE("../a.png")},
    {"ImageIsADevice", imageAt("zero"), REFERS_OUTSIDE("zero")},
    {"ImageOfText", embedded("hello"), "image 0 is corrupt: it is neither PNG nor JPEG"},
    {"ImageCutInItsHeader", embedded(tests::pngBytes(2, 2).substr(0, 20)),
     "image 0 is corrupt: it ends inside of its header"},
    {"ImageCutInItsPixels", embedded(tests::pngBytes(2, 2).substr(0, 50)),
     "image 0 is corrupt: it ends too early"},
    {"ImageOfNoWidth", embedded(tests::pngBytes(0, 5)),
     "image 0 has 0 x 5 texels; at most 8192 x 8192 are allowed"},
    {"ImageTooWide", embedded(tests::pngBytes(8193, 1)),
     "image 0 has 8193 x 1 texels; at most 8192 x 8192 are allowed"},
    {"ImageBomb", embedded(tests::pngBytes(65535, 65535)),
     "image 0 has 65535 x 65535 texels; at most 8192 x 8192 are allowed"},
    {"ImageBombOfTheLargestSize", embedded(tests::pngBytes(0xFFFFFFFF, 0xFFFFFFFF)),
     "image 0 has 4294967295 x 4294967295 texels; at most 8192 x 8192 are allowed"},
    {"ImageOfFewerPixelsThanItsHeader", embedded(tests::pngBytes(8192, 8192)),
     "image 0 is corrupt: it has fewer pixels than its header tells"},
    {"JpegBomb",
     embedded(
         std::string("\xFF\xD8\xFF\xC0\0\x11\x08\xFF\xFF\xFF\xFF\3\1\x11\0\2\x11\0\3\x11\0", 21)),
     "image 0 has 65535 x 65535 texels; at most 8192 x 8192 are allowed"},
    {"JpegOfManyScans",
     [] {
         std::string bytes("\xFF\xD8\xFF\xC2\0\x11\x08\x20\0\x20\0\3\1\x11\0\2\x11\0\3\x11\0", 21);
         for (int i = 0; i < 1000; ++i) bytes += std::string("\xFF\xDA\0\x08\1\1\0\0\0\0", 10);
         return embedded(bytes)();
     },
     "image 0 has 1000 scans; at most 100 are allowed"},
};

class BadFileTest : public testing::TestWithParam<BadFile> {};

TEST_P(BadFileTest, IsRefusedWithItsMessage) {
    namespace fs = std::filesystem;
    const BadFile& bad = GetParam();
    const TemporaryFolder folder;
    const std::string scene = folder.write("in/scene.gltf", bad.bytes());
    folder.write("a.bin", std::string("four"));
    folder.write("a.png", tests::pngBytes(1, 1));
    folder.write("in/short.bin", std::string("abc"));
    folder.write("in/empty.bin", std::string());
    fs::create_directory(folder.path() / "in/folder");
    fs::create_symlink("/dev/zero", folder.path() / "in/zero");
    fs::create_symlink("..", folder.path() / "in/up");
    std::string expected = scene + ": " + bad.message;
    const auto at = expected.find("DIR/");  // messages that name a file of the scene's folder
    if (at != std::string::npos) expected.replace(at, 3, fs::path(scene).parent_path().string());
    EXPECT_EQ(messageOf([&] { loadGltf(scene); }), expected);
}

INSTANTIATE_TEST_SUITE_P(All, BadFileTest, testing::ValuesIn(kBadFiles),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(BadFolderTest, AFolderGivenAsSceneIsNamed) {
    const TemporaryFolder folder;
    const std::string path = folder.path().string();
    EXPECT_EQ(messageOf([&] { loadGltf(path); }), path + ": '" + path + "' is not a regular file");
}

TEST(BadImageTest, WhatFollowsTheLastPixelOfAPngIsNotInflated) {
    // A stored block of one byte, then a type of block that there is not: where a bomb would stand
    const std::string tail = std::string("\0\1\0\xFE\xFF?", 6) + std::string(5000, '\xFF');
    const std::string bytes = embedded(tests::pngBytes(1, 1, tail))();
    const Scene scene = loadGlb(bytes.data(), bytes.size(), "test.glb");
    EXPECT_EQ(scene.images.at(0).texels, (std::vector<std::uint8_t>{0, 0, 0, 255}));
}

}  // namespace
}  // namespace penumbra::scene
