// SPDX-License-Identifier: MIT
// Files that are broken, hostile or ask for what is not supported: always an Error of one line that
// names the file, never a crash, a hang or a large allocation. Whole messages, one file a row, are
// in bad_scenes_test.cpp and bad_files_test.cpp; here are rules that need several files.
#include <limits>
#include <random>

#include "tests/scene/gltf_test_file.h"

namespace penumbra::scene {
namespace {

std::string refuse(const std::string& rest, const GltfTestFile& file = {}) {
    const std::string message = messageOf([&] { file.load(rest); });
    EXPECT_EQ(message.rfind("test.glb: ", 0), 0U) << message;
    return message;
}

std::string refuseBytes(const std::string& bytes) {
    return messageOf([&] { loadGlb(bytes.data(), bytes.size(), "test.glb"); });
}

/// Refuses a primitive over accessor 0, given by its text; one buffer of 36 bytes, view 0 over it.
std::string refuseAccessor(const std::string& text, const std::string& views = "") {
    GltfTestFile file;
    file.view(rightTriangle());
    file.accessorText("{" + text + "}");
    return refuse(GltfTestFile::meshOf(R"("attributes":{"POSITION":0})") + views, file);
}

TEST(GltfMalformedTest, NumbersThatAreNotWholeOrTooLargeAreRefused) {
    // tinygltf would read the first as 0 and wrap the others
    for (const char* const offset : {"-4", "4.0", "1e1", "4294967296", "99999999999999999999"})
        EXPECT_TRUE(contains(
            refuseAccessor(fmt::format(
                R"("bufferView":0,"componentType":5126,"type":"VEC3","count":1,"byteOffset":{})",
                offset)),
            fmt::format("\"byteOffset\": {}", offset)));
    EXPECT_NO_THROW(GltfTestFile().load(R"("nodes":[{"extras":{"count":-1.5}}])"));
}

TEST(GltfMalformedTest, AccessorsWithoutDataCannotAskForMuchMemory) {
    // Either alone would be fine
    GltfTestFile file;
    file.accessorText(R"({"componentType":5126,"type":"VEC3","count":3})");
    file.accessorText(R"({"componentType":5126,"type":"VEC3","count":22369620})");
    EXPECT_TRUE(contains(
        refuse(GltfTestFile::meshOf(R"("attributes":{"POSITION":0},"targets":[{"POSITION":1}])"),
               file),
        "256 MiB"));
}

TEST(GltfMalformedTest, ViewsAndBuffersMustFit) {
    const auto with = [](const std::string& view) {
        const std::string json =
            R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4}],"bufferViews":[{)" + view +
            R"(}],"images":[{"bufferView":0,"mimeType":"image/png"}],"textures":[{"source":0}],)"
            R"("materials":[{"emissiveTexture":{"index":0}}]})";
        return refuseBytes(GltfTestFile::wrap(json, {1, 2, 3, 4}));
    };
    EXPECT_TRUE(contains(with(R"("buffer":0,"byteLength":5)"), "5 bytes from offset 0"));
    EXPECT_TRUE(contains(with(R"("buffer":0,"byteOffset":2000000000,"byteLength":4)"),
                         "offset 2000000000"));
    EXPECT_TRUE(contains(with(R"("buffer":7,"byteLength":4)"), "buffer"));
    EXPECT_TRUE(contains(with(R"("buffer":0,"byteLength":4,"byteStride":5)"), "byteStride"));
}

TEST(GltfMalformedTest, StridesShorterThanAnElementAreRefused) {
    GltfTestFile file;
    const int view = file.view(rightTriangle(), 4);
    file.accessorText(
        fmt::format(R"({{"bufferView":{},"componentType":5126,"type":"VEC3","count":3}})", view));
    EXPECT_TRUE(contains(refuse(GltfTestFile::meshOf(R"("attributes":{"POSITION":0})"), file),
                         "byteStride 4"));
}

TEST(GltfMalformedTest, SparsePartsAreChecked) {
    const auto with = [](int count, std::uint16_t largest, int indexType) {
        GltfTestFile file;
        const int indices = file.view<std::uint16_t>({0, largest});
        const int values = file.view(std::vector<float>(6, 1));
        file.accessorText(fmt::format(
            R"({{"componentType":5126,"count":3,"type":"VEC3","sparse":{{"count":{},"indices":)"
            R"({{"bufferView":{},"componentType":{}}},"values":{{"bufferView":{}}}}}}})",
            count, indices, indexType, values));
        return refuse(GltfTestFile::meshOf(R"("attributes":{"POSITION":0})"), file);
    };
    EXPECT_TRUE(contains(with(2, 3, 5123), "sparse index 3"));
    EXPECT_TRUE(contains(with(3, 1, 5123), "sparse indices"));
    EXPECT_TRUE(contains(with(4, 1, 5123), "4 sparse elements"));
    EXPECT_TRUE(contains(with(0, 1, 5123), "0 sparse elements"));
    EXPECT_TRUE(contains(with(2, 1, 5126), "componentType 5126"));
}

TEST(GltfMalformedTest, PrimitivesMustAgreeWithThemselves) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");            // 0
    file.accessor<float>({0, 0, 1, 0, 0, 1}, "VEC3");  // 1
    const auto primitive = [&](const std::string& members) {
        return refuse(GltfTestFile::meshOf(members), file);
    };
    EXPECT_TRUE(contains(primitive(R"("attributes":{"POSITION":0},"indices":9)"), "out of bounds"));
    EXPECT_TRUE(contains(primitive(R"("attributes":{"POSITION":0,"NORMAL":1})"),
                         "2 elements, but POSITION has 3"));
    EXPECT_TRUE(contains(primitive(R"("attributes":{"POSITION":-1})"), "\"POSITION\": -1"));
    EXPECT_TRUE(contains(primitive(R"("attributes":{"POSITION":0}},{"attributes":{"POSITION":0},)"
                                   R"("targets":[{"POSITION":0}])"),
                         "0 and 1 morph targets"));
    EXPECT_TRUE(contains(primitive(R"("mode":4)"), "attributes"));
}

TEST(GltfMalformedTest, ScenesMustListRoots) {
    EXPECT_TRUE(contains(refuse(R"("nodes":[{}],"scenes":[{"nodes":[0,0]}])"), "must list roots"));
    EXPECT_TRUE(contains(refuse(R"("scene":0)"), "scene 0"));
}

TEST(GltfMalformedTest, TransformsMustBeAffineAndFinite) {
    EXPECT_TRUE(contains(refuse(R"("nodes":[{"translation":[1,2]}])"), "3 are needed"));
    EXPECT_TRUE(contains(refuse(R"("nodes":[{"rotation":[0,0,1]}])"), "4 are needed"));
    EXPECT_TRUE(warnsOnce(GltfTestFile().load(R"("nodes":[{"rotation":[0,0,0,0]}])"), "length 0"));
    std::string chain = R"("nodes":[{})";
    for (int i = 1; i < 20; ++i)
        chain += fmt::format(R"(,{{"scale":[1e30,1e30,1e30]{}}})",
                             i == 1 ? "" : fmt::format(R"(,"children":[{}])", i - 1));
    EXPECT_TRUE(contains(refuse(chain + "]"), "world matrix that is not finite"));
}

TEST(GltfMalformedTest, InverseBindMatricesMustBeEnoughAffineAndFinite) {
    const auto with = [](float bottom, float corner, const std::string& joints) {
        GltfTestFile file;
        file.accessor<float>({corner, 0, 0, bottom, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
        return refuse(
            R"("nodes":[{},{}],"skins":[{"inverseBindMatrices":0,"joints":[)" + joints + "]}]",
            file);
    };
    EXPECT_TRUE(contains(with(0, 1, "0,1"), "1 matrices for 2 joints"));
    EXPECT_TRUE(contains(with(0.5F, 1, "0"), "0 0 0 1 is needed"));
    EXPECT_TRUE(contains(with(0, std::numeric_limits<float>::infinity(), "0"), "finite"));
}

TEST(GltfMalformedTest, RequiredExtensionsMustBeSupported) {
    for (const char* const name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                   "KHR_texture_basisu", "VENDOR_unheard_of"}) {
        const std::string message =
            refuse(fmt::format(R"("extensionsUsed":["{0}"],"extensionsRequired":["{0}"])", name));
        EXPECT_TRUE(contains(message, name));
        EXPECT_TRUE(contains(message, "supported are EXT_lights_area, KHR_lights_punctual"));
    }
    EXPECT_NO_THROW(GltfTestFile().load(R"("extensionsRequired":["KHR_mesh_quantization"])"));
}

TEST(GltfMalformedTest, IgnoredExtensionsAreNamedOnce) {
    const Scene scene = GltfTestFile().load(
        R"("extensionsUsed":["KHR_materials_sheen","KHR_materials_sheen","KHR_materials_unlit"])");
    EXPECT_TRUE(warnsOnce(scene, "KHR_materials_sheen"));
    EXPECT_EQ(scene.warnings.size(), 1U);
}

TEST(GltfMalformedTest, ContainersAreCheckedBeforeTheyAreParsed) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    const std::string good = file.glb(GltfTestFile::meshOf(R"("attributes":{"POSITION":0})"));
    for (std::size_t length = 0; length < good.size(); ++length)
        refuseBytes(good.substr(0, length));
    std::string version = good;
    version[4] = 1;
    EXPECT_TRUE(contains(refuseBytes(version), "version 1"));
    // A BIN chunk that claims the 8 bytes of its own header too; tinygltf would read past the end
    std::string bin = good;
    bin[bin.size() - file.bin().size() - 8] = static_cast<char>(file.bin().size() + 8);
    EXPECT_TRUE(contains(refuseBytes(bin), "BIN chunk of 44 bytes, of which 36 are there"));
    EXPECT_TRUE(contains(refuseBytes("{}"), "is not valid"));
    EXPECT_TRUE(contains(refuseBytes(R"({"asset":{"version":"1.0"}})"), "is glTF 1.0"));
    EXPECT_TRUE(contains(refuseBytes(R"({"asset":{"version":"2.0","minVersion":"2.9"}})"), "2.9"));
}

TEST(GltfMalformedTest, DeepJsonIsRefused) {
    for (const char* const open : {"[", R"({"a":)"}) {
        std::string text = R"({"asset":{"version":"2.0","extras":)";
        for (int i = 0; i < 1000000; ++i) text += open;
        EXPECT_TRUE(contains(refuseBytes(text), "nests deeper"));
    }
}

TEST(GltfMalformedTest, ManyBuffersCannotCopyTheBinChunk) {
    std::string json = R"({"asset":{"version":"2.0"},"buffers":[)";
    for (int i = 0; i < 100000; ++i) json += R"({"byteLength":100000},)";
    json += R"({"byteLength":100000}]})";
    EXPECT_TRUE(contains(refuseBytes(GltfTestFile::wrap(json, std::vector<std::uint8_t>(100000))),
                         "100001 buffers"));
}

TEST(GltfMalformedTest, BytesChangedAtRandomGiveAnErrorOrAScene) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    file.accessor<std::uint8_t>({0, 1, 2}, "SCALAR");
    file.accessor<std::uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
    file.accessor(std::vector<float>(12, 1), "VEC4");
    file.accessor<float>({0, 1}, "SCALAR");
    file.accessor<float>({0, 0, 0, 1, 1, 1}, "VEC3");
    const std::string good = file.glb(
        R"("nodes":[{"mesh":0,"skin":0,"children":[1]},{"extensions":{"KHR_lights_punctual":)"
        R"({"light":0}},"extras":{"radius":1}}],"skins":[{"joints":[1]}],"extensions":)"
        R"({"KHR_lights_punctual":{"lights":[{"type":"spot","spot":{},"color":[1,1,1]}]}},)"
        R"("meshes":[{"weights":[1],"primitives":[{"attributes":{"POSITION":0,"JOINTS_0":2,)"
        R"("WEIGHTS_0":3},"indices":1,"targets":[{"POSITION":0}],"material":0}]}],)"
        R"("materials":[{"normalTexture":{"index":0}}],"textures":[{"source":0,"sampler":0}],)"
        R"("samplers":[{"wrapS":33071}],"images":[{"uri":"data:image/png;base64,iVBORw0KGgoAAAANSUhEU)"
        R"(gAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR4nGP4z8DwHwgbABB5A359Y87XAAAAAElFTkSuQmCC"}],)"
        R"("animations":[{"samplers":[{"input":4,"output":5}],"channels":[{"sampler":0,)"
        R"("target":{"node":1,"path":"scale"}}]}])");
    ASSERT_NO_THROW(loadGlb(good.data(), good.size(), "test.glb"));
    std::mt19937 random(1);
    for (int round = 0; round < 20000; ++round) {
        std::string bytes = good;
        const auto changes = 1 + random() % 3;
        for (unsigned i = 0; i < changes; ++i)  // mostly digits, so that most files still parse
            bytes[random() % bytes.size()] =
                static_cast<char>(random() % 2 == 0 ? '0' + random() % 10 : random() % 256);
        try {
            loadGlb(bytes.data(), bytes.size(), "test.glb");
        } catch (const Error& error) {
            EXPECT_EQ(std::string(error.what()).rfind("test.glb: ", 0), 0U);
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace penumbra::scene
