// SPDX-License-Identifier: MIT
#include "runtime/call_error.h"

#include "runtime/opencl.h"

namespace penumbra::runtime {
namespace {

constexpr double kMegabyte = 1024.0 * 1024.0;
constexpr int kNvidiaFault = -9999;  // an invalid access of an earlier kernel

bool isMemoryCode(int code) {
    return code == CL_MEM_OBJECT_ALLOCATION_FAILURE || code == CL_OUT_OF_RESOURCES ||
           code == CL_OUT_OF_HOST_MEMORY;
}

bool isLossCode(int code) {
    return code == CL_DEVICE_NOT_AVAILABLE || code == CL_INVALID_CONTEXT ||
           code == CL_INVALID_COMMAND_QUEUE || code == kNvidiaFault;
}

}  // namespace

std::string memoryFigures(const Device& device) {
    return fmt::format(
        "{:.1f} MB are in use of {:.1f} MB, the largest single allocation is {:.1f} MB",
        static_cast<double>(device.memory().current) / kMegabyte,
        static_cast<double>(device.memoryLimitBytes()) / kMegabyte,
        static_cast<double>(device.info().maxAllocBytes) / kMegabyte);
}

Error lostError(const Device& device, const std::string& call, int code) {
    return Error(fmt::format("device {} was lost: {} failed with OpenCL error {}; see the system's "
                             "log for the driver's reason, or choose another with --device",
                             device.info().name, call, code),
                 ExitCode::noDevice);
}

Error callError(const Device& device, const std::string& call, int code) {
    if (isLossCode(code)) return lostError(device, call, code);
    if (isMemoryCode(code))
        return Error(
            fmt::format("out of memory on {}: {} failed with OpenCL error {}; {}; use fewer "
                        "light samples, or a smaller size or resolution",
                        device.info().name, call, code, memoryFigures(device)),
            ExitCode::outOfMemory);
    return Error(
        fmt::format("{} failed on {} with OpenCL error {}", call, device.info().name, code));
}

}  // namespace penumbra::runtime
