// SPDX-License-Identifier: MIT
// Cache entry: a text head (magic, digest of the rest, signatures) and the driver's binary. The
// digest is checked before the driver sees the binary, since some crash on a damaged one.
#include "runtime/program.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "runtime/crash_notice.h"
#include "runtime/digest.h"
#include "runtime/error.h"
#include "runtime/opencl.h"
#include "runtime/slow_notice.h"
#include "runtime/whole_file.h"

namespace penumbra::runtime {
namespace {

constexpr const char* kMagic = "penumbra-program-1";

std::string optionsFor(const DeviceInfo& info, const std::vector<std::string>& defines) {
    // -cl-std=CL1.2 is the dialect that every driver takes; -g is refused by two
    std::string options = "-cl-std=CL1.2 -cl-kernel-arg-info";
    options += fmt::format(" -DLANES={}", info.lanes);
    if (info.isCpu) options += " -DON_CPU=1";
    if (info.platform == "Oclgrind") options += " -DRACE_CHECKED=1";
    for (const auto& define : defines) options += " -D" + define;
    return options;
}

std::string keyOf(const DeviceInfo& info, const std::string& options, const std::string& source) {
    return digest(fmt::format("{}|{}|{}|{}|{}|{}", info.platform, info.name, info.driver,
                              info.version, options, source));
}

}  // namespace

std::string cacheFolder() {
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg)
        return std::string(xdg) + "/penumbra";
    if (const char* home = std::getenv("HOME"); home && *home)
        return std::string(home) + "/.cache/penumbra";
    return "";
}

Program::Program(Device& device, const std::string& name, const std::vector<std::string>& defines)
    : device_(&device), name_(name) {
    const char* source = programSource(name);
    require(source != nullptr, "no embedded program '{}'", name);
    const auto start = std::chrono::steady_clock::now();
    auto options = optionsFor(device.info(), defines);
    for (const auto& define : device.faults().defines[name]) options += " -D" + define;
    auto& made = device.madePrograms()[name + options];
    if (made) {
        program_ = made->program_;
        signatures_ = made->signatures_;
        return;
    }
    const bool ownCache = device.options().cache && !device.info().cachesBuilds;
    const auto folder = ownCache ? cacheFolder() : "";
    const auto path =
        folder.empty() ? "" : folder + "/" + name + "-" + keyOf(device.info(), options, source);
    if (!path.empty() && load(path)) {
        ++device.programs().loaded;
    } else {
        SlowNotice notice(fmt::format("compiling '{}' for {} (kept for the next start)", name,
                                      device.info().name));
        build(source, options);
        readSignatures();
        ++device.programs().built;
        if (!path.empty()) save(path);
    }
    keepAnnouncingCrashes();
    const auto elapsed = std::chrono::steady_clock::now() - start;
    device.programs().ms += std::chrono::duration<double, std::milli>(elapsed).count();
    made = std::make_shared<const Program>(*this);
}

void Program::build(const std::string& source, const std::string& options) {
    try {
        program_ = std::make_shared<cl::Program>(device_->context(), source);
        program_->build({device_->handle()}, options.c_str());
    } catch (const cl::Error& error) {
        std::string log;
        if (program_) log = program_->getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_->handle());
        throw Error(
            fmt::format("program '{}' does not build on {} with '{}' (OpenCL error {}); choose "
                        "another device with --device or update its driver, which says:\n{}",
                        name_, device_->info().name, options, error.err(), log),
            ExitCode::noDevice);
    }
}

void Program::readSignatures() {
    std::vector<cl::Kernel> kernels;
    program_->createKernels(&kernels);
    for (const auto& kernel : kernels) {
        const std::string name = kernel.getInfo<CL_KERNEL_FUNCTION_NAME>().c_str();
        auto& types = signatures_[name];
        const auto count = kernel.getInfo<CL_KERNEL_NUM_ARGS>();
        for (cl_uint i = 0; i < count; ++i) {
            std::string type;
            try {
                type = kernel.getArgInfo<CL_KERNEL_ARG_TYPE_NAME>(i).c_str();
            } catch (const cl::Error&) {
                type = "?";  // a driver without argument information; sizes are still checked by it
            }
            std::erase(type, ' ');
            types.push_back(type);
        }
    }
}

bool Program::load(const std::string& path) try {
    std::ifstream file(path, std::ios::binary);
    if (!file) return false;
    std::string magic, sum, head;
    std::getline(file, magic);
    std::getline(file, sum);
    std::stringstream rest;
    rest << file.rdbuf();
    const std::string body = rest.str();
    require(magic == kMagic, "it is of another version");
    const auto split = body.find('\n');
    require(sum == digest(body) && split != std::string::npos, "it is damaged");
    signatures_ = nlohmann::json::parse(body.substr(0, split)).get<decltype(signatures_)>();
    const std::vector<unsigned char> binary(body.begin() + static_cast<std::ptrdiff_t>(split) + 1,
                                            body.end());
    program_ = std::make_shared<cl::Program>(device_->context(),
                                             std::vector<cl::Device>{device_->handle()},
                                             cl::Program::Binaries{binary});
    program_->build({device_->handle()});
    return true;
} catch (const std::exception& error) {
    device_->warn(fmt::format("{}: the cached program is compiled anew: {}", path, error.what()));
    signatures_.clear();
    return false;
}

void Program::save(const std::string& path) const try {
    const auto binaries = program_->getInfo<CL_PROGRAM_BINARIES>();
    if (binaries.empty() || binaries[0].empty()) return;
    std::string body = nlohmann::json(signatures_).dump() + "\n";
    body.append(binaries[0].begin(), binaries[0].end());
    const std::string text = fmt::format("{}\n{}\n", kMagic, digest(body)) + body;
    const std::filesystem::path entry(path);
    std::filesystem::create_directories(entry.parent_path());
    removeAbandoned(entry.parent_path().string(), {entry.filename().string()});
    WholeFile file(path);
    file.write(text.data(), text.size());
    file.commit();
} catch (const std::exception&) {
    // Once for all programs: each would fail for the same reason
    device_->warn(
        fmt::format("programs are compiled at every start, as the cache {} cannot be "
                    "written; choose another folder with XDG_CACHE_HOME, or --no-cache",
                    cacheFolder()));
}

}  // namespace penumbra::runtime
