// SPDX-License-Identifier: MIT
#include "runtime/buffer.h"

#include "runtime/call_error.h"
#include "runtime/opencl.h"
#include "runtime/profiler.h"

namespace penumbra::runtime {
namespace {

constexpr double kMegabyte = 1024.0 * 1024.0;

[[noreturn]] void throwOutOfMemory(const Device& device, const std::string& label,
                                   std::uint64_t bytes, const std::string& reason) {
    throw Error(
        fmt::format(
            "out of memory on {}: {} needs {:.1f} MB, {} ({}); use fewer light samples, a smaller "
            "size or resolution, or raise --memory",
            device.info().name, label, static_cast<double>(bytes) / kMegabyte,
            memoryFigures(device), reason),
        ExitCode::outOfMemory);
}

template <typename Call>
void checked(const Memory& memory, const char* what, Call&& call) {
    try {
        if (memory.device().faults().loss.struck()) throw cl::Error(CL_DEVICE_NOT_AVAILABLE, what);
        call();
    } catch (const cl::Error& error) {
        throw callError(memory.device(),
                        fmt::format("{} of '{}' ({} bytes)", what, memory.label(), memory.bytes()),
                        error.err());
    }
}

}  // namespace

Memory::Memory(Device& device, std::string label, std::uint64_t bytes)
    : device_(&device), label_(std::move(label)), bytes_(bytes) {
    // Kernels may be handed an empty list: a driver wants at least a byte behind a pointer
    const std::uint64_t size = bytes ? bytes : 4;
    if (size > device.info().maxAllocBytes)
        throwOutOfMemory(device, label_, size, "larger than the device allows");
    if (device.memory().current + size > device.memoryLimitBytes())
        throwOutOfMemory(device, label_, size, "the limit is reached");
    try {
        if (device.faults().allocation.strikes())
            throw cl::Error(CL_MEM_OBJECT_ALLOCATION_FAILURE, "a test's fault");
        buffer_ = std::make_shared<cl::Buffer>(device.context(), CL_MEM_READ_WRITE, size);
    } catch (const cl::Error& error) {
        throwOutOfMemory(device, label_, size, fmt::format("OpenCL error {}", error.err()));
    }
    device.accountMemory(static_cast<std::int64_t>(bytes_));
}

Memory::~Memory() {
    release();
}

Memory::Memory(Memory&& other) noexcept {
    *this = std::move(other);
}

Memory& Memory::operator=(Memory&& other) noexcept {
    if (this == &other) return *this;
    release();
    device_ = other.device_;
    label_ = std::move(other.label_);
    bytes_ = std::exchange(other.bytes_, 0);
    buffer_ = std::exchange(other.buffer_, nullptr);
    return *this;
}

void Memory::release() {
    if (buffer_) device_->accountMemory(-static_cast<std::int64_t>(bytes_));
    buffer_ = nullptr;
    bytes_ = 0;
}

void Memory::write(const void* data, std::uint64_t offset, std::uint64_t bytes) {
    if (!bytes) return;
    checked(*this, "upload",
            [&] { device_->queue().enqueueWriteBuffer(*buffer_, CL_TRUE, offset, bytes, data); });
}

void Memory::stage(std::shared_ptr<const void> data, std::uint64_t bytes) {
    if (!bytes) return;
    checked(*this, "upload",
            [&] { device_->queue().enqueueWriteBuffer(*buffer_, CL_FALSE, 0, bytes, data.get()); });
    device_->keepUntilFinish(std::move(data));
}

void Memory::read(void* data, std::uint64_t offset, std::uint64_t bytes) const {
    if (!bytes) return;
    checked(*this, "download",
            [&] { device_->queue().enqueueReadBuffer(*buffer_, CL_TRUE, offset, bytes, data); });
}

void Memory::fill(const void* pattern, std::size_t patternBytes, std::uint64_t bytes) {
    if (!bytes) return;
    checked(*this, "fill", [&] {
        const cl_int error = clEnqueueFillBuffer(device_->queue()(), (*buffer_)(), pattern,
                                                 patternBytes, 0, bytes, 0, nullptr, nullptr);
        if (error != CL_SUCCESS) throw cl::Error(error, "clEnqueueFillBuffer");
    });
}

void Memory::copyFrom(const Memory& source, std::uint64_t bytes) {
    if (!bytes) return;
    checked(*this, "copy",
            [&] { device_->queue().enqueueCopyBuffer(*source.buffer_, *buffer_, 0, 0, bytes); });
}

}  // namespace penumbra::runtime
