// SPDX-License-Identifier: MIT
// The glTF loader's materials, textures, images and external files.
#include <stb_image_write.h>

#include <cmath>

#include "tests/scene/gltf_test_file.h"

namespace penumbra::scene {
namespace {

/// 2 x 1: opaque red, half-transparent green; written with Python's zlib, not by us.
const char* const kPng =
    "iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAYAAAD0In+KAAAAD0lEQVR4nGP4z8DwHwgbABB5A359Y87XAAAAAElFTkSu"
    "QmCC";
/// 8193 x 1 texels, black.
const char* const kWidePng =
    "iVBORw0KGgoAAAANSUhEUgAAIAEAAAABCAYAAACZiUteAAAANklEQVR4nO3BAQ0AAADCoPdP7WYOoAAAAAAAAAAAAAAAAA"
    "AAAAAAAAAAAAAAAAAAAAAAAACAG4AFAAEdCyhIAAAAAElFTkSuQmCC";

void appendBytes(void* bytes, void* data, int size) {
    const auto* const from = static_cast<const std::uint8_t*>(data);
    auto& out = *static_cast<std::vector<std::uint8_t>*>(bytes);
    out.insert(out.end(), from, from + size);
}

/// A JPEG of one grey level.
std::vector<std::uint8_t> greyJpeg(int size, std::uint8_t level) {
    const std::vector<std::uint8_t> texels(static_cast<std::size_t>(3 * size * size), level);
    std::vector<std::uint8_t> bytes;
    stbi_write_jpg_to_func(appendBytes, &bytes, size, size, 3, texels.data(), 95);
    return bytes;
}

std::vector<std::uint8_t> redPng() {
    const std::vector<std::uint8_t> texel = {255, 0, 0, 255};
    std::vector<std::uint8_t> bytes;
    stbi_write_png_to_func(appendBytes, &bytes, 1, 1, 4, texel.data(), 4);
    return bytes;
}

Material loadMaterial(const std::string& members) {
    return GltfTestFile().load(R"("materials":[{)" + members + "}]").materials.at(0);
}

/// JSON of one material whose base colour is image 0, given by its members.
std::string textured(const std::string& image, const std::string& textureInfo = "",
                     const std::string& sampler = "") {
    return fmt::format(
        R"("materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0{}}}}}}}],)"
        R"("textures":[{{"source":0{}}}],"images":[{{{}}}])",
        textureInfo, sampler.empty() ? "" : R"(,"sampler":0}],"samplers":[{)" + sampler, image);
}

std::string pngUri(const char* base64 = kPng) {
    return fmt::format(R"("uri":"data:image/png;base64,{}")", base64);
}

TEST(GltfMaterialTest, FactorsHaveTheDefaultsOfGltf) {
    const Material material = loadMaterial("");
    EXPECT_EQ(material.baseColor, glm::vec4(1));
    EXPECT_EQ(material.metallic, 1);
    EXPECT_EQ(material.roughness, 1);
    EXPECT_EQ(material.emissive, glm::vec3(0));
    EXPECT_EQ(material.alphaMode, AlphaMode::opaque);
    EXPECT_EQ(material.alphaCutoff, 0.5F);
    EXPECT_FALSE(material.doubleSided || material.unlit);
    EXPECT_EQ(material.baseColorTexture.image, -1);
}

TEST(GltfMaterialTest, FactorsAndExtensionsAreRead) {
    const Material material = loadMaterial(
        R"("name":"m","doubleSided":true,"alphaMode":"MASK","alphaCutoff":0.75,)"
        R"("emissiveFactor":[0.5,0.25,0],"pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],)"
        R"("metallicFactor":0.5,"roughnessFactor":0},"extensions":{"KHR_materials_unlit":{},)"
        R"("KHR_materials_emissive_strength":{"emissiveStrength":8},)"
        R"("KHR_materials_transmission":{"transmissionFactor":0.9}})");
    EXPECT_EQ(material.name, "m");
    EXPECT_EQ(material.baseColor, glm::vec4(0.1F, 0.2F, 0.3F, 0.4F));
    EXPECT_EQ(material.metallic, 0.5F);
    EXPECT_EQ(material.roughness, 0);
    EXPECT_EQ(material.emissive, glm::vec3(4, 2, 0));
    EXPECT_EQ(material.alphaMode, AlphaMode::mask);
    EXPECT_EQ(material.alphaCutoff, 0.75F);
    EXPECT_EQ(material.transmission, 0.9F);
    EXPECT_TRUE(material.doubleSided && material.unlit);
    EXPECT_EQ(loadMaterial(R"("alphaMode":"BLEND")").alphaMode, AlphaMode::blend);
}

TEST(GltfMaterialTest, AllFourTexturesAreReadAndAnImageIsDecodedOnce) {
    const Scene scene = GltfTestFile().load(
        R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},)"
        R"("metallicRoughnessTexture":{"index":1,"texCoord":1}},"normalTexture":{"index":0,"scale":0.5},)"
        R"("emissiveTexture":{"index":0},"occlusionTexture":{"index":2}}],)"
        R"("textures":[{"source":1},{"source":1},{"source":0}],"images":[{"uri":"data:image/png;base64,AAAA"},{)" +
        pngUri() + "}]");
    const Material& material = scene.materials[0];
    ASSERT_EQ(scene.images.size(), 1U) << "the occlusion texture, which is corrupt, is not used";
    for (const TextureRef& reference :
         {material.baseColorTexture, material.metallicRoughnessTexture, material.normalTexture,
          material.emissiveTexture})
        EXPECT_EQ(reference.image, 0);
    EXPECT_EQ(material.metallicRoughnessTexture.uvSet, 1);
    EXPECT_EQ(material.normalScale, 0.5F);
}

TEST(GltfMaterialTest, PngImagesAreDecodedFromTheTop) {
    const Scene scene = GltfTestFile().load(textured(pngUri()));
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].width, 2);
    EXPECT_EQ(scene.images[0].height, 1);
    EXPECT_EQ(scene.images[0].texels, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 128}));
}

TEST(GltfMaterialTest, JpegImagesInABufferViewAreDecoded) {
    GltfTestFile file;
    file.view<std::uint8_t>({1, 2, 3});
    const int view = file.view(greyJpeg(8, 100));
    const Scene scene =
        file.load(textured(fmt::format(R"("bufferView":{},"mimeType":"image/jpeg")", view)));
    ASSERT_EQ(scene.images.size(), 1U);
    ASSERT_EQ(scene.images[0].texels.size(), 8U * 8U * 4U);
    EXPECT_NEAR(scene.images[0].texels[0], 100, 2);
    EXPECT_EQ(scene.images[0].texels[3], 255);
}

TEST(GltfMaterialTest, SamplersSetWrapAndFilter) {
    const auto load = [](const std::string& sampler) {
        return GltfTestFile().load(textured(pngUri(), "", sampler)).materials[0].baseColorTexture;
    };
    const TextureRef plain = load(R"("name":"s")");
    EXPECT_EQ(plain.wrapU, Wrap::repeat);
    EXPECT_FALSE(plain.nearest);
    const TextureRef other = load(R"("wrapS":33071,"wrapT":33648,"magFilter":9728)");
    EXPECT_EQ(other.wrapU, Wrap::clamp);
    EXPECT_EQ(other.wrapV, Wrap::mirror);
    EXPECT_TRUE(other.nearest);
    EXPECT_TRUE(contains(messageOf([&] { load(R"("wrapS":7)"); }), "wraps by 7"));
}

TEST(GltfMaterialTest, TextureTransformsScaleThenTurnThenMove) {
    const TextureRef reference =
        GltfTestFile()
            .load(
                textured(pngUri(),
                         R"(,"texCoord":0,"extensions":{"KHR_texture_transform":{"offset":[10,20],)"
                         R"("scale":[2,3],"rotation":1.5707963267948966,"texCoord":1}})"))
            .materials[0]
            .baseColorTexture;
    EXPECT_EQ(reference.uvSet, 1) << "the extension's texCoord wins";
    // A quarter turn, counter-clockwise with v down: (u, v) -> (v, -u), here of (2, 6)
    const glm::vec2 uv = reference.uvFromUv * glm::vec3(1, 2, 1);
    EXPECT_NEAR(uv.x, 16, 1e-5);
    EXPECT_NEAR(uv.y, 18, 1e-5);
}

TEST(GltfMaterialTest, ThirdUvSetsAreNamedAndNotUsed) {
    const Scene scene = GltfTestFile().load(textured(pngUri(), R"(,"texCoord":2)"));
    EXPECT_EQ(scene.materials[0].baseColorTexture.image, -1);
    EXPECT_TRUE(warnsOnce(scene, "TEXCOORD_2"));
}

TEST(GltfMaterialTest, OtherImageFormatsAreNamedAndTheFactorIsUsed) {
    GltfTestFile file;
    const std::string webp = "RIFF1234WEBPVP8 ";
    const int view = file.view(std::vector<char>(webp.begin(), webp.end()));
    const Scene scene = file.load(textured(fmt::format(R"("bufferView":{},"name":"leaf")", view)));
    EXPECT_EQ(scene.materials[0].baseColorTexture.image, -1);
    EXPECT_TRUE(warnsOnce(scene, R"(image 0 "leaf" is WebP)"));
    EXPECT_TRUE(warnsOnce(GltfTestFile().load(textured(R"("uri":"data:image/ktx2;base64,AAAA")")),
                          "image/ktx2"));
    const std::string noSource = R"("materials":[{"emissiveTexture":{"index":0}}],)"
                                 R"("textures":[{"extensions":{"EXT_texture_webp":{"source":0}}}])";
    EXPECT_TRUE(warnsOnce(GltfTestFile().load(noSource), "EXT_texture_webp"));
}

TEST(GltfMaterialTest, LargeImagesAreRefusedFromTheirHeader) {
    EXPECT_TRUE(contains(messageOf([] { GltfTestFile().load(textured(pngUri(kWidePng))); }),
                         "8193 x 1 texels; at most 8192 x 8192"));
}

TEST(GltfMaterialTest, CorruptImagesAreRefused) {
    const std::string text = "data:image/png;base64,AAAAAAAA";
    EXPECT_TRUE(
        contains(messageOf([&] { GltfTestFile().load(textured(R"("uri":")" + text + "\"")); }),
                 "image 0 is corrupt"));
    std::vector<std::uint8_t> cut = redPng();
    cut.resize(40);
    GltfTestFile file;
    const int view = file.view(cut);
    EXPECT_TRUE(
        contains(messageOf([&] { file.load(textured(fmt::format(R"("bufferView":{})", view))); }),
                 "image 0 is corrupt"));
}

TEST(GltfMaterialTest, MaterialsOutOfRangeAreRefused) {
    EXPECT_TRUE(contains(messageOf([] { loadMaterial(R"("alphaMode":"GLASS")"); }),
                         "allowed are OPAQUE, MASK, BLEND"));
    EXPECT_TRUE(
        contains(messageOf([] { loadMaterial(R"("pbrMetallicRoughness":{"roughnessFactor":2})"); }),
                 "roughnessFactor = 2"));
    EXPECT_TRUE(contains(
        messageOf([] { loadMaterial(R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1]})"); }),
        "must be 4"));
    EXPECT_TRUE(
        contains(messageOf([] { loadMaterial(R"("normalTexture":{"index":3})"); }), "texture 3"));
}

TEST(GltfMaterialTest, PrimitivesWithoutMaterialGetADefaultOne) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    const std::string meshes =
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}},{"attributes":{"POSITION":0},)"
        R"("material":0}]}],"materials":[{"name":"own","doubleSided":true}])";
    const Scene scene = file.load(meshes);
    ASSERT_EQ(scene.materials.size(), 2U);
    EXPECT_EQ(scene.meshes[0].primitives[0].material, 1);
    EXPECT_FALSE(scene.materials[1].doubleSided);
    EXPECT_EQ(scene.meshes[0].primitives[1].material, 0);
}

/// A .gltf with an external buffer and an external image, in a folder below `folder`.
std::string writeScene(const TemporaryFolder& folder, const std::string& bufferUri,
                       const std::string& imageUri) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    folder.write("scene/data/a b.bin", file.bin());
    folder.write("scene/c+d.png", redPng());
    folder.write("secret.bin", file.bin());
    folder.write("secret.png", redPng());
    const std::string rest = file.meshOf(R"("attributes":{"POSITION":0})") + "," +
                             textured(fmt::format(R"("uri":"{}")", imageUri));
    return folder.write("scene/scene.gltf", file.json(rest, bufferUri));
}

TEST(GltfFilesTest, ExternalBuffersAndImagesAreReadBesideTheScene) {
    const TemporaryFolder folder;
    const Scene scene = loadGltf(writeScene(folder, "data/a%20b.bin", "./c+d.png"));
    EXPECT_EQ(scene.name, "scene");
    EXPECT_EQ(scene.meshes[0].primitives[0].positions[1], glm::vec3(1, 0, 0));
    ASSERT_EQ(scene.images.size(), 1U);
    EXPECT_EQ(scene.images[0].texels, (std::vector<std::uint8_t>{255, 0, 0, 255}));
}

TEST(GltfFilesTest, BuffersInDataUrisAreRead) {
    // 36 bytes of the right triangle: only the two 1.0F (00 00 80 3F) are not 0
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    const TemporaryFolder folder;
    const std::string uri =
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    const Scene scene = loadGltf(
        folder.write("s.gltf", file.json(file.meshOf(R"("attributes":{"POSITION":0})"), uri)));
    EXPECT_EQ(scene.meshes[0].primitives[0].positions[2], glm::vec3(0, 1, 0));
}

TEST(GltfFilesTest, PathsThatLeaveTheFolderAreRefused) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder.path() / "scene");
    std::filesystem::create_symlink(folder.path() / "secret.bin", folder.path() / "scene/link.bin");
    std::filesystem::create_symlink(folder.path(), folder.path() / "scene/up");
    std::filesystem::create_symlink("/dev/zero", folder.path() / "scene/zero");
    const std::string secret = (folder.path() / "secret.bin").string();
    for (const std::string& uri :
         {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"),
          std::string("data/../../secret.bin"), secret, "file://" + secret, std::string("link.bin"),
          std::string("up/secret.bin"), std::string("/dev/zero"), std::string("zero"),
          std::string("data"), std::string("C:/x.bin"), std::string("..\\\\secret.bin")})
        EXPECT_TRUE(contains(messageOf([&] { loadGltf(writeScene(folder, uri, "c+d.png")); }),
                             "inside of the scene's folder"))
            << uri;
    EXPECT_TRUE(contains(
        messageOf([&] { loadGltf(writeScene(folder, "data/a%20b.bin", "../secret.png")); }),
        "'../secret.png'"));
}

TEST(GltfFilesTest, MissingFilesAreNamed) {
    const TemporaryFolder folder;
    EXPECT_TRUE(contains(messageOf([&] { loadGltf(writeScene(folder, "gone.bin", "c+d.png")); }),
                         "gone.bin"));
    EXPECT_TRUE(
        contains(messageOf([&] { loadGltf(writeScene(folder, "data/a%20b.bin", "gone.png")); }),
                 "'gone.png'"));
    EXPECT_TRUE(contains(messageOf([&] { loadGltf((folder.path() / "no.glb").string()); }),
                         "does not exist"));
    EXPECT_TRUE(
        contains(messageOf([&] { loadGltf(folder.path().string()); }), "not a regular file"));
    EXPECT_TRUE(contains(messageOf([] { loadGltf("/dev/zero"); }), "not a regular file"));
    EXPECT_TRUE(contains(messageOf([] { loadGltf(""); }), "does not exist"));
}

TEST(GltfFilesTest, ScenesInMemoryMayNotReferToFiles) {
    EXPECT_TRUE(contains(messageOf([] { GltfTestFile().load(textured(R"("uri":"c.png")")); }),
                         "test.glb: refers to the file 'c.png'"));
}

TEST(GltfFilesTest, BinaryFilesAreKnownByTheirMagic) {
    GltfTestFile file;
    file.accessor(rightTriangle(), "VEC3");
    const TemporaryFolder folder;
    const std::string path =
        folder.write("named.gltf", file.glb(file.meshOf(R"("attributes":{"POSITION":0})")));
    EXPECT_EQ(loadGltf(path).meshes.size(), 1U);
}

}  // namespace
}  // namespace penumbra::scene
