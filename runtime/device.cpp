// SPDX-License-Identifier: MIT
#include "runtime/device.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <utility>

#include "runtime/call_error.h"
#include "runtime/driver_cache.h"
#include "runtime/error.h"
#include "runtime/opencl.h"
#include "runtime/profiler.h"
#include "runtime/quirks.h"

namespace penumbra::runtime {
namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool contains(const std::string& text, const std::string& part) {
    return lower(text).find(lower(part)) != std::string::npos;
}

/// Vector width of explicit SIMD code: what the CPU's registers hold, 1 where threads are lanes.
int lanesOf(const cl::Device& device, bool isCpu) {
    if (!isCpu) return 1;
    const auto native = device.getInfo<CL_DEVICE_NATIVE_VECTOR_WIDTH_FLOAT>();
    return native >= 16 ? 16 : 8;
}

DeviceInfo describe(const cl::Platform& platform, const cl::Device& device) {
    DeviceInfo info;
    info.platform = platform.getInfo<CL_PLATFORM_NAME>();
    info.name = device.getInfo<CL_DEVICE_NAME>();
    info.vendor = device.getInfo<CL_DEVICE_VENDOR>();
    info.driver = device.getInfo<CL_DRIVER_VERSION>();
    info.version = device.getInfo<CL_DEVICE_VERSION>();
    const auto type = device.getInfo<CL_DEVICE_TYPE>();
    info.isGpu = (type & CL_DEVICE_TYPE_GPU) != 0;
    info.isCpu = (type & CL_DEVICE_TYPE_CPU) != 0;
    info.computeUnits = static_cast<int>(device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
    info.clockMhz = static_cast<int>(device.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>());
    info.globalBytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    info.maxAllocBytes = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    info.localBytes = device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>();
    info.maxWorkGroup = static_cast<int>(device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>());
    const auto extensions = device.getInfo<CL_DEVICE_EXTENSIONS>();
    info.atomics64 = extensions.find("cl_khr_int64_extended_atomics") != std::string::npos;
    info.lanes = lanesOf(device, info.isCpu);
    if (device.getInfo<CL_DEVICE_COMPILER_AVAILABLE>() == CL_FALSE) {
        info.usable = false;
        info.whyNot = "has no compiler for OpenCL C";
    } else if (device.getInfo<CL_DEVICE_ENDIAN_LITTLE>() == CL_FALSE) {
        info.usable = false;
        info.whyNot = "is big-endian";
    }
    applyQuirks(info);
    return info;
}

std::vector<cl::Device> devicesOf(const cl::Platform& platform) {
    std::vector<cl::Device> devices;
    try {
        platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {
        devices.clear();  // a platform without devices is not an error
    }
    return devices;
}

std::vector<cl::Platform> platforms() {
    // One compiled kernel per entry instead of one per launch shape; read by PoCL alone
    setenv("POCL_WORK_GROUP_SPECIALIZATION", "0", 0);
    prepareDriverCache();
    std::vector<cl::Platform> all;
    try {
        cl::Platform::get(&all);
    } catch (const cl::Error&) {
        all.clear();  // no ICD at all
    }
    return all;
}

double speedGuess(const DeviceInfo& info) {
    return static_cast<double>(info.computeUnits) * std::max(info.clockMhz, 1) *
           (info.isGpu ? 64.0 : info.lanes);
}

std::string listNames(const std::vector<DeviceInfo>& devices) {
    std::string names;
    for (std::size_t i = 0; i < devices.size(); ++i)
        names +=
            fmt::format("{}{}: {} / {}", i ? "; " : "", i, devices[i].platform, devices[i].name);
    return names;
}

[[noreturn]] void throwNoDevice(const std::string& message) {
    throw Error(message, ExitCode::noDevice);
}

DeviceChoice fastest(const std::vector<DeviceInfo>& devices, bool gpu, bool cpu, const char* why) {
    const DeviceInfo* best = nullptr;
    for (const auto& info : devices) {
        if (!info.usable || !info.chosenUnasked || !((gpu && info.isGpu) || (cpu && info.isCpu)))
            continue;
        if (!best || speedGuess(info) > speedGuess(*best)) best = &info;
    }
    if (!best) return {devices.size(), ""};
    return {static_cast<std::size_t>(best - devices.data()), why};
}

bool isNumber(const std::string& text) {
    return !text.empty() && text.size() < 6 &&
           std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); });
}

std::size_t findRequested(const std::vector<DeviceInfo>& devices, const std::string& request) {
    const auto none = devices.size();
    if (isNumber(request)) return std::min<std::size_t>(std::stoul(request), none);
    const auto colon = request.find(':');
    if (colon != std::string::npos) {
        const auto platform = request.substr(0, colon), device = request.substr(colon + 1);
        if (isNumber(platform) && isNumber(device)) {
            for (std::size_t i = 0; i < none; ++i)
                if (devices[i].platformIndex == std::stoi(platform) &&
                    devices[i].deviceIndex == std::stoi(device))
                    return i;
            return none;
        }
        for (std::size_t i = 0; i < none; ++i)
            if (contains(devices[i].platform, platform) && contains(devices[i].name, device))
                return i;
    }
    for (std::size_t i = 0; i < none; ++i)
        if (contains(devices[i].platform + " / " + devices[i].name, request)) return i;
    return none;
}

}  // namespace

std::vector<DeviceInfo> listDevices() {
    std::vector<DeviceInfo> list;
    int platformIndex = 0;
    for (const auto& platform : platforms()) {
        int deviceIndex = 0;
        for (const auto& device : devicesOf(platform)) {
            list.push_back(describe(platform, device));
            list.back().platformIndex = platformIndex;
            list.back().deviceIndex = deviceIndex++;
        }
        ++platformIndex;
    }
    return list;
}

std::string icdSearchPath() {
    const char* vendors = std::getenv("OCL_ICD_VENDORS");
    return vendors ? fmt::format("OCL_ICD_VENDORS={}", vendors) : "/etc/OpenCL/vendors/*.icd";
}

DeviceChoice chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& asked) {
    if (devices.empty())
        throwNoDevice(fmt::format(
            "no OpenCL device: the loader looked for drivers in {}; install one, such as "
            "pocl-opencl-icd for CPUs, or the GPU vendor's OpenCL driver",
            icdSearchPath()));
    const char* environment = std::getenv("PENUMBRA_DEVICE");
    const bool fromEnvironment = asked.empty() && environment && *environment;
    const std::string request = fromEnvironment ? environment : asked;
    DeviceChoice choice{devices.size(), ""};
    if (request.empty()) {
        choice = fastest(devices, true, false, "the fastest GPU");
        if (choice.index == devices.size())
            choice = fastest(devices, false, true, "no GPU was found; the fastest CPU");
    } else if (lower(request) == "cpu" || lower(request) == "gpu") {
        const bool gpu = lower(request) == "gpu";
        choice = fastest(devices, gpu, !gpu, gpu ? "the fastest GPU" : "the fastest CPU");
    } else {
        choice.index = findRequested(devices, request);
        choice.why = "asked for by name or index";
    }
    if (choice.index >= devices.size())
        throwNoDevice(fmt::format(
            "no OpenCL device matches {}'{}'; found {}; allowed: cpu, gpu, an "
            "index, platform:device, or part of a name",
            fromEnvironment ? "PENUMBRA_DEVICE=" : "--device ", request, listNames(devices)));
    const auto& info = devices[choice.index];
    if (!info.usable)
        throwNoDevice(fmt::format("device {} {}; choose another with --device: {}", info.name,
                                  info.whyNot, listNames(devices)));
    return choice;
}

struct Device::Handles {
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;
};

Device::Device(const DeviceInfo& info, const DeviceOptions& options)
    : info_(info), options_(options), handles_(std::make_unique<Handles>()) {
    const auto allPlatforms = platforms();
    const auto devices = devicesOf(allPlatforms.at(static_cast<std::size_t>(info.platformIndex)));
    handles_->device = devices.at(static_cast<std::size_t>(info.deviceIndex));
    try {
        handles_->context = cl::Context(handles_->device);
        handles_->queue = cl::CommandQueue(handles_->context, handles_->device,
                                           options.profiling ? CL_QUEUE_PROFILING_ENABLE : 0);
    } catch (const cl::Error& error) {
        throwNoDevice(fmt::format("device {} does not open: {} failed with OpenCL error {}",
                                  info.name, error.what(), error.err()));
    }
    profiler_ = std::make_unique<Profiler>(*this, options.profiling);
    if (info.platform == "Portable Computing Language" && !prepareDriverCache().empty())
        warn(prepareDriverCache());
}

Device::~Device() {
    try {
        handles_->queue.finish();
    } catch (const cl::Error&) {
        // the device is gone; nothing is left to wait for
    }
}

cl::Context& Device::context() const {
    return handles_->context;
}
cl::CommandQueue& Device::queue() const {
    return handles_->queue;
}
cl::Device& Device::handle() const {
    return handles_->device;
}

void Device::finish() {
    try {
        if (faults_.loss.struck()) throw cl::Error(CL_DEVICE_NOT_AVAILABLE, "clFinish");
        handles_->queue.finish();
    } catch (const cl::Error& error) {
        // Nothing is asked for here that could be refused, but memory on first use
        if (error.err() == CL_MEM_OBJECT_ALLOCATION_FAILURE)
            throw callError(*this, "running kernels", error.err());
        throw lostError(*this, error.what(), error.err());
    }
    staged_.clear();
}

void Device::flush() {
    try {
        handles_->queue.flush();
    } catch (const cl::Error& error) {
        throw lostError(*this, error.what(), error.err());
    }
}

void Device::keepUntilFinish(std::shared_ptr<const void> data) {
    staged_.push_back(std::move(data));
}

std::uint64_t Device::memoryLimitBytes() const {
    return options_.memoryLimitBytes ? std::min(options_.memoryLimitBytes, info_.globalBytes)
                                     : info_.globalBytes;
}

void Device::warn(const std::string& warning) {
    if (std::find(warnings_.begin(), warnings_.end(), warning) == warnings_.end())
        warnings_.push_back(warning);
}

std::vector<std::string> Device::takeWarnings() {
    return std::exchange(warnings_, {});
}

void Device::accountMemory(std::int64_t bytes) {
    memory_.current =
        static_cast<std::uint64_t>(static_cast<std::int64_t>(memory_.current) + bytes);
    memory_.peak = std::max(memory_.peak, memory_.current);
}

}  // namespace penumbra::runtime
