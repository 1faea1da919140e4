// SPDX-License-Identifier: MIT
#include "tests/support/fixtures.h"

#include <cstdlib>
#include <filesystem>

namespace penumbra::tests {

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
