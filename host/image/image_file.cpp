// SPDX-License-Identifier: MIT
#include "host/image/image_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "host/image/tone_map.h"
#include "runtime/error.h"
#include "runtime/whole_file.h"

namespace penumbra::image {

std::string extensionOf(const std::string& path) {
    auto extension = std::filesystem::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

void requireReadable(int width, int height, std::size_t channels) {
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    require(
        width > 0 && height > 0 && width <= kMaxSide && height <= kMaxSide && pixels <= kMaxPixels,
        "{} x {} pixels; allowed are 1 to {} along a side and {} million in all", width, height,
        kMaxSide, kMaxPixels / 1'000'000);
    require(channels <= kMaxPlaneBytes / sizeof(float) / pixels,
            "{} channels of {} x {} pixels; allowed are {} GiB in all", channels, width, height,
            kMaxPlaneBytes >> 30U);
}

const std::vector<float>* LoadedImage::find(const std::string& name) const {
    for (const auto& channel : channels)
        if (channel.name == name) return &channel.values;
    return nullptr;
}

LoadedImage readImage(const std::string& path) {
    std::error_code error;
    require(std::filesystem::exists(path, error), "{}: no such file", path);
    require(std::filesystem::is_regular_file(path, error), "{}: is not a regular file", path);
    const auto extension = extensionOf(path);
    if (extension == ".exr") return readExrFile(path);
    if (extension == ".png") return readPngFile(path);
    throw Error(fmt::format("{}: '{}' is not an image that can be read; allowed: .exr, .png", path,
                            extension));
}

}  // namespace penumbra::image

namespace penumbra {

void writeExr(const std::string& path, const Frame& frame) {
    image::writeExrFile(path, frame);
}

std::string depthMapsPath(const std::string& framePath) {
    const std::filesystem::path file(framePath);
    return (file.parent_path() / (file.stem().string() + ".depth-maps.exr")).string();
}

std::string masksPath(const std::string& framePath) {
    const std::filesystem::path file(framePath);
    return (file.parent_path() / (file.stem().string() + ".mask.exr")).string();
}

void writePng(const std::string& path, const Frame& frame) {
    const auto bytes =
        image::encodePng(image::toneMap(frame), frame.width, frame.height, frame.fingerprint);
    runtime::WholeFile file(path);
    file.write(bytes.data(), bytes.size());
    file.commit();
}

std::string readFingerprint(const std::string& path) try {
    for (const auto& [key, value] : image::readImage(path).header)
        if (key == "penumbra.fingerprint") return value;
    return "";
} catch (const std::exception&) {
    return "";  // absent or damaged: rendered anew
}

}  // namespace penumbra
