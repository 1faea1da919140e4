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

const std::vector<float>* LoadedImage::find(const std::string& name) const {
    for (const auto& channel : channels)
        if (channel.name == name) return &channel.values;
    return nullptr;
}

LoadedImage readImage(const std::string& path) {
    require(std::filesystem::is_regular_file(path), "{}: no such file", path);
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
