// SPDX-License-Identifier: MIT
// Helpers of all stages of the glTF loader, and the check of the extensions that a file names.
#include "host/scene/gltf_context.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace penumbra::scene {

namespace {

constexpr std::array<std::string_view, 7> kExtensions = {"EXT_lights_area",
                                                         "KHR_lights_punctual",
                                                         "KHR_materials_emissive_strength",
                                                         "KHR_materials_transmission",
                                                         "KHR_materials_unlit",
                                                         "KHR_mesh_quantization",
                                                         "KHR_texture_transform"};

bool isSupported(const std::string& extension) {
    return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

}  // namespace

void LoadContext::warn(const std::string& message) {
    std::string line = toOneLine(message);
    if (warned_.insert(line).second) scene.warnings.push_back(std::move(line));
}

void LoadContext::charge(std::uint64_t count, std::uint64_t bytesEach, const std::string& what) {
    // count may be anything up to 2^64 - 1, so divide rather than multiply
    require(bytesEach == 0 || count <= bytesLeft_ / bytesEach,
            "{} has {} elements of {} bytes; all arrays and images of a file together may take {} "
            "GiB of memory",
            what, count, bytesEach, kMaxDecodedBytes >> 30U);
    bytesLeft_ -= count * bytesEach;
}

void LoadContext::chargeZeros(std::uint64_t count, std::uint64_t bytesEach,
                              const std::string& what) {
    require(count <= zeroBytesLeft_ / bytesEach,
            "{} has {} elements of {} bytes, and no bufferView that holds them; all such zeros "
            "together may take {} MiB of memory",
            what, count, bytesEach, kMaxZeroBytes >> 20U);
    zeroBytesLeft_ -= count * bytesEach;
}

std::string describe(const char* kind, std::size_t index, const std::string& name) {
    return name.empty() ? fmt::format("{} {}", kind, index)
                        : fmt::format("{} {} \"{}\"", kind, index, name);
}

void checkIndex(int index, std::size_t size, const std::string& user, const char* kind) {
    require(index >= 0 && static_cast<std::size_t>(index) < size,
            "{} refers to {} {}, but the file has {} of them, counted from 0", user, kind, index,
            size);
}

void checkExtensions(LoadContext& context) {
    for (const std::string& extension : context.model.extensionsRequired)
        require(isSupported(extension),
                "requires the extension {}, which is not supported; supported are {}", extension,
                fmt::join(kExtensions, ", "));
    for (const std::string& extension : context.model.extensionsUsed)
        if (!isSupported(extension))
            context.warn(fmt::format("extension {} is ignored", extension));
}

}  // namespace penumbra::scene
