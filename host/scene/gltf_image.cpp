// SPDX-License-Identifier: MIT
// Images: encoded bytes to 8-bit RGBA. PNG goes to libpng, which inflates no more than the pixels
// of its header; stb_image would inflate a stream of any length. JPEG goes to stb_image, which is
// shown nothing else.
#include <stb_image.h>

#include <array>
#include <cstring>
#include <memory>
#include <string_view>

#include "host/image/png.h"
#include "host/scene/gltf_accessor.h"
#include "host/scene/gltf_context.h"

namespace penumbra::scene {

namespace {

constexpr int kMaxJpegScans = 100;  // encoders write ten

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

bool isPng(const ByteSpan& bytes) {
    return startsWith(bytes, "\x89PNG\r\n\x1A\n");
}

bool isJpeg(const ByteSpan& bytes) {
    return startsWith(bytes, "\xFF\xD8\xFF");
}

ByteSpan encodedBytes(const LoadContext& context, const tinygltf::Image& image,
                      const std::string& user) {
    if (image.bufferView >= 0) return checkBufferView(context, image.bufferView, user);
    return {image.image.data(), image.image.size()};
}

/// Each scan of a JPEG passes over the whole image, however few bytes it has.
void checkScans(const ByteSpan& bytes, const std::string& user) {
    int scans = 0;
    for (std::uint64_t i = 0; i + 1 < bytes.size; ++i)
        scans += bytes.data[i] == 0xFF && bytes.data[i + 1] == 0xDA ? 1 : 0;
    require(scans <= kMaxJpegScans, "{} has {} scans; at most {} are allowed", user, scans,
            kMaxJpegScans);
}

std::string failureReason() {
    const char* const reason = stbi_failure_reason();  // null where stb_image gave none
    return reason == nullptr ? "not a JPEG that stb_image reads" : reason;
}

/// Width and height as the header tells them.
std::array<std::uint32_t, 2> headerSize(const ByteSpan& bytes, const std::string& user) {
    if (isPng(bytes)) {
        require(bytes.size >= 24, "{} is corrupt: it ends inside of its header", user);
        std::array<std::uint32_t, 2> size{};
        for (std::size_t i = 0; i < 8; ++i) size[i / 4] = size[i / 4] << 8U | bytes.data[16 + i];
        return size;
    }
    int width = 0, height = 0, channels = 0;
    const int length = static_cast<int>(bytes.size);  // files have at most 2^31 - 1 bytes
    require(stbi_info_from_memory(bytes.data, length, &width, &height, &channels) != 0,
            "{} is corrupt: {}", user, failureReason());
    return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

Image decodeJpeg(const ByteSpan& bytes, const std::string& user) {
    checkScans(bytes, user);
    int width = 0, height = 0, channels = 0;
    const int length = static_cast<int>(bytes.size);
    const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
        stbi_load_from_memory(bytes.data, length, &width, &height, &channels, 4), stbi_image_free);
    require(decoded != nullptr, "{} is corrupt: {}", user, failureReason());
    const auto texels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return {width, height, {decoded.get(), decoded.get() + texels * 4}};
}

Image decodePng(const ByteSpan& bytes, const std::string& user) try {
    image::PngPixels pixels = image::decodePng(bytes.data, bytes.size);
    return {pixels.width, pixels.height, std::move(pixels.rgba)};
} catch (const Error& error) {
    throw Error(fmt::format("{} is corrupt: {}", user, error.what()));
}

Image decode(LoadContext& context, const ByteSpan& bytes, const std::string& user) {
    const auto [width, height] = headerSize(bytes, user);
    require(width > 0 && height > 0 && width <= kMaxImageSide && height <= kMaxImageSide,
            "{} has {} x {} texels; at most {} x {} are allowed", user, width, height,
            kMaxImageSide, kMaxImageSide);
    context.charge(static_cast<std::uint64_t>(width) * height, 4, user);
    return isPng(bytes) ? decodePng(bytes, user) : decodeJpeg(bytes, user);
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
    require(isPng(bytes) || isJpeg(bytes), "{} is corrupt: it is neither PNG nor JPEG", user);
    Image decoded = decode(context, bytes, user);
    sceneImage = static_cast<int>(context.scene.images.size());
    context.scene.images.push_back(std::move(decoded));
    return sceneImage;
}

}  // namespace penumbra::scene
