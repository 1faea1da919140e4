// SPDX-License-Identifier: MIT
// Images: encoded bytes to 8-bit RGBA by stb_image, which is shown nothing but PNG and JPEG.
#include <stb_image.h>

#include <cstring>
#include <memory>
#include <string_view>

#include "host/scene/gltf_accessor.h"
#include "host/scene/gltf_context.h"

namespace penumbra::scene {

namespace {

bool startsWith(const ByteSpan& bytes, std::string_view magic, std::size_t offset = 0) {
    return bytes.size >= offset + magic.size() &&
           std::memcmp(bytes.data + offset, magic.data(), magic.size()) == 0;
}

/// Name of a format that is known but not read; empty for PNG, JPEG and what is no image.
std::string foreignFormat(const ByteSpan& bytes, const std::string& mediaType) {
    if (startsWith(bytes, "RIFF") && startsWith(bytes, "WEBP", 8)) return "WebP";
    if (startsWith(bytes, "\xABKTX ")) return "KTX";
    if (startsWith(bytes, "DDS ")) return "DDS";
    if (startsWith(bytes, "GIF8")) return "GIF";
    if (startsWith(bytes, "BM")) return "BMP";
    if (startsWith(bytes, "ftypavif", 4)) return "AVIF";
    // tinygltf does not decode data URIs of other media types
    if (bytes.size == 0 && mediaType.rfind("image/", 0) == 0) return mediaType;
    return {};
}

bool isPngOrJpeg(const ByteSpan& bytes) {
    return startsWith(bytes, "\x89PNG\r\n\x1A\n") || startsWith(bytes, "\xFF\xD8\xFF");
}

ByteSpan encodedBytes(const LoadContext& context, const tinygltf::Image& image,
                      const std::string& user) {
    if (image.bufferView >= 0) return checkBufferView(context, image.bufferView, user);
    return {image.image.data(), image.image.size()};
}

Image decode(LoadContext& context, const ByteSpan& bytes, const std::string& user) {
    const int size = static_cast<int>(bytes.size);  // files have at most 2^31 - 1 bytes
    int width = 0, height = 0, channels = 0;
    require(stbi_info_from_memory(bytes.data, size, &width, &height, &channels) != 0,
            "{} is corrupt: {}", user, stbi_failure_reason());
    require(width > 0 && height > 0 && width <= kMaxImageSide && height <= kMaxImageSide,
            "{} has {} x {} texels; at most {} x {} are allowed", user, width, height,
            kMaxImageSide, kMaxImageSide);
    const std::uint64_t texels =
        static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    context.charge(texels, 4, user);
    const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
        stbi_load_from_memory(bytes.data, size, &width, &height, &channels, 4), stbi_image_free);
    require(decoded != nullptr, "{} is corrupt: {}", user, stbi_failure_reason());
    return {width, height, {decoded.get(), decoded.get() + texels * 4}};
}

std::string mediaTypeOf(const tinygltf::Image& image) {
    if (image.uri.rfind("data:", 0) != 0) return image.mimeType;
    return image.uri.substr(5, image.uri.find_first_of(";,") - 5);
}

}  // namespace

int loadImage(LoadContext& context, int gltfImage) {
    const auto known = context.sceneImageOfGltf.find(gltfImage);
    if (known != context.sceneImageOfGltf.end()) return known->second;
    const tinygltf::Image& image = context.model.images[static_cast<std::size_t>(gltfImage)];
    const bool external = !image.uri.empty() && image.uri.rfind("data:", 0) != 0;
    std::string user = describe("image", static_cast<std::size_t>(gltfImage), image.name);
    if (external) user += fmt::format(" ('{}')", toOneLine(image.uri));
    const ByteSpan bytes = encodedBytes(context, image, user);
    int& sceneImage = context.sceneImageOfGltf[gltfImage];
    sceneImage = -1;
    const std::string foreign = foreignFormat(bytes, mediaTypeOf(image));
    if (!foreign.empty()) {
        context.warn(
            fmt::format("{} is {}; only PNG and JPEG are read, so its materials use their "
                        "factors alone",
                        user, foreign));
        return -1;
    }
    require(bytes.size > 0 || !external, "{} was not found or is empty", user);
    require(isPngOrJpeg(bytes), "{} is corrupt: it is neither PNG nor JPEG", user);
    Image decoded = decode(context, bytes, user);
    sceneImage = static_cast<int>(context.scene.images.size());
    context.scene.images.push_back(std::move(decoded));
    return sceneImage;
}

}  // namespace penumbra::scene
