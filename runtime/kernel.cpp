// SPDX-License-Identifier: MIT
#include "runtime/kernel.h"

#include "runtime/call_error.h"
#include "runtime/opencl.h"
#include "runtime/profiler.h"

namespace penumbra::runtime {
namespace {

std::uint64_t roundUp(std::uint64_t value, std::uint64_t step) {
    return (value + step - 1) / step * step;
}

}  // namespace

KernelBase::KernelBase(const Program& program, const std::string& name)
    : device_(&program.device()), name_(name) {
    try {
        kernel_ = std::make_shared<cl::Kernel>(program.handle(), name.c_str());
    } catch (const cl::Error& error) {
        throw Error(fmt::format("program '{}' has no kernel '{}' on {} (OpenCL error {})",
                                program.name(), name, device_->info().name, error.err()));
    }
}

void KernelBase::checkSignature(const Program& program, const std::string* hostTypes,
                                std::size_t count) const {
    const auto found = program.signatures().find(name_);
    if (found == program.signatures().end()) return;
    const auto& types = found->second;
    require(types.size() == count, "kernel {} has {} parameters, the host passes {}", name_,
            types.size(), count);
    for (std::size_t i = 0; i < count; ++i)
        require(types[i] == "?" || types[i] == hostTypes[i],
                "kernel {}: parameter {} is {} on the device, {} on the host", name_, i, types[i],
                hostTypes[i]);
}

void KernelBase::setBytes(unsigned index, std::size_t bytes, const void* value) {
    try {
        kernel_->setArg(index, bytes, value);
    } catch (const cl::Error& error) {
        throw Error(fmt::format("kernel {}: parameter {} of {} bytes is refused (OpenCL error {})",
                                name_, index, bytes, error.err()));
    }
}

void KernelBase::setMemory(unsigned index, const Memory& memory) {
    require(memory.allocated(), "kernel {}: parameter {} has no memory", name_, index);
    try {
        kernel_->setArg(index, memory.handle());
    } catch (const cl::Error& error) {
        throw callError(*device_, fmt::format("parameter {} of kernel {}", index, name_),
                        error.err());
    }
}

void KernelBase::enqueue(Range items, Range group) {
    if (items.x == 0 || items.y == 0 || items.z == 0) return;
    const cl::NDRange global(roundUp(items.x, group.x), roundUp(items.y, group.y),
                             roundUp(items.z, group.z));
    const cl::NDRange local(group.x, group.y, group.z);
    Profiler& profiler = device_->profiler();
    try {
        if (device_->faults().loss.strikes())
            throw cl::Error(CL_DEVICE_NOT_AVAILABLE, "a test's fault");
        device_->queue().enqueueNDRangeKernel(*kernel_, cl::NullRange, global, local, nullptr,
                                              profiler.newEvent());
    } catch (const cl::Error& error) {
        throw callError(
            *device_,
            fmt::format("the start of kernel {} over {} x {} x {} items in groups of {} x {} x {}",
                        name_, items.x, items.y, items.z, group.x, group.y, group.z),
            error.err());
    }
    profiler.launched();
}

}  // namespace penumbra::runtime
