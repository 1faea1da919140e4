// SPDX-License-Identifier: MIT
#include "tests/support/fixtures.h"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>

namespace penumbra::tests {

runtime::Device& device() {
    // Never destroyed: drivers may be gone already when static objects are
    static auto* const opened = [] {
        const auto devices = runtime::listDevices();
        const bool asked = std::getenv("PENUMBRA_DEVICE") != nullptr;
        return new runtime::Device(
            devices.at(runtime::chooseDevice(devices, asked ? "" : "cpu").index));
    }();
    return *opened;
}

const runtime::Program& program(const std::string& name) {
    static auto& programs = *new std::map<std::string, std::unique_ptr<runtime::Program>>;
    auto& entry = programs[name];
    if (!entry) entry = std::make_unique<runtime::Program>(device(), name);
    return *entry;
}

std::string assetFolder() {
    const char* environment = std::getenv("PENUMBRA_ASSETS");
    const std::string folder =
        environment ? environment : std::string(PENUMBRA_SOURCE_DIR) + "/../shared/assets";
    return std::filesystem::is_directory(folder) ? folder : "";
}

std::string temporaryFolder(const std::string& name) {
    const auto folder = std::filesystem::path(PENUMBRA_BINARY_DIR) / "test-files" / name;
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder.string();
}

}  // namespace penumbra::tests
