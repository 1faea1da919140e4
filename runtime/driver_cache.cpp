// SPDX-License-Identifier: MIT
#include "runtime/driver_cache.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "runtime/error.h"

namespace penumbra::runtime {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kRoomBytes = 16 << 20;  // kernels of a few techniques take 2 MB

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// Why kernels cannot be kept in `folder`; empty if they can.
std::string whyNot(const std::string& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) return error.message();
    std::string probe = folder + "/probe-XXXXXX";
    const int descriptor = mkstemp(probe.data());
    if (descriptor < 0) return std::strerror(errno);
    close(descriptor);
    unlink(probe.c_str());
    const auto space = fs::space(folder, error);
    if (!error && space.available < kRoomBytes)
        return fmt::format("{:.1f} MB are left on its disk",
                           static_cast<double>(space.available) / (1 << 20));
    return "";
}

/// A folder that is removed when the process ends.
struct OwnFolder {
    ~OwnFolder() {
        std::error_code ignored;
        if (!path.empty()) fs::remove_all(path, ignored);
    }
    std::string path;
};

std::string replaceDriverCache() {
    const auto folder = driverCacheFolder();
    if (folder.empty()) return "";
    const auto reason = whyNot(folder);
    if (reason.empty()) return "";
    static OwnFolder own;
    std::error_code ignored;
    auto name = (fs::temp_directory_path(ignored) / "penumbra-XXXXXX").string();
    if (!mkdtemp(name.data())) return "";  // PoCL will say what it thinks of its folder
    own.path = name;
    setenv("POCL_CACHE_DIR", name.c_str(), 1);
    return fmt::format(
        "kernels are compiled at every start, as PoCL's cache {} cannot be used: {}; "
        "choose another folder with POCL_CACHE_DIR",
        folder, reason);
}

}  // namespace

std::string driverCacheFolder() {
    if (auto folder = variable("POCL_CACHE_DIR"); !folder.empty()) return folder;
    if (const auto folder = variable("XDG_CACHE_HOME"); !folder.empty())
        return folder + "/pocl/kcache";
    if (const auto folder = variable("HOME"); !folder.empty())
        return folder + "/.cache/pocl/kcache";
    return "";
}

const std::string& prepareDriverCache() {
    static const std::string problem = replaceDriverCache();
    return problem;
}

}  // namespace penumbra::runtime
