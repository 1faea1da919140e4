// SPDX-License-Identifier: MIT
// A kernel whose parameters are checked against the host's types.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>

#include "runtime/buffer.h"
#include "runtime/program.h"

namespace cl {
class Kernel;
}

namespace penumbra::runtime {

// Names of host types in OpenCL C; shared structs get theirs from SHARED_STRUCT.
inline const char* deviceType(const int*) {
    return "int";
}
inline const char* deviceType(const std::uint32_t*) {
    return "uint";
}
inline const char* deviceType(const float*) {
    return "float";
}
inline const char* deviceType(const std::uint64_t*) {
    return "ulong";
}
inline const char* deviceType(const std::uint16_t*) {
    return "ushort";
}
inline const char* deviceType(const std::uint8_t*) {
    return "uchar";
}
template <typename T>
std::string deviceType(const Buffer<T>*) {
    return std::string(deviceType(static_cast<const T*>(nullptr))) + "*";
}

/// Work-items along x, y, z; rounded up to whole work-groups, so kernels return early outside.
struct Range {
    std::uint64_t x = 1, y = 1, z = 1;
};

/// What Kernel<> does without knowing types.
class KernelBase {
  public:
    KernelBase(const Program& program, const std::string& name);
    const std::string& name() const { return name_; }

  protected:
    void checkSignature(const Program& program, const std::string* hostTypes,
                        std::size_t count) const;
    void setBytes(unsigned index, std::size_t bytes, const void* value);
    void setMemory(unsigned index, const Memory& memory);
    void enqueue(Range items, Range group);

    Device* device_;
    std::string name_;
    std::shared_ptr<cl::Kernel> kernel_;
};

/// A kernel of a program. Args... are the host types of its parameters, in order: a shared struct,
/// a number, or Buffer<T> for a pointer to T.
template <typename... Args>
class Kernel : public KernelBase {
  public:
    /// Throws Error naming both types when a parameter differs from Args.
    Kernel(const Program& program, const std::string& name) : KernelBase(program, name) {
        const std::array<std::string, sizeof...(Args)> types{
            std::string(deviceType(static_cast<const Args*>(nullptr)))...};
        checkSignature(program, types.data(), types.size());
    }

    /// Enqueues; nothing waits. An empty range launches nothing.
    void launch(Range items, Range group, const Args&... args) {
        unsigned index = 0;
        (set(index++, args), ...);
        enqueue(items, group);
    }

  private:
    template <typename T>
    void set(unsigned index, const Buffer<T>& buffer) {
        setMemory(index, buffer.memory());
    }
    template <typename T>
    void set(unsigned index, const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        setBytes(index, sizeof(T), &value);
    }
};

}  // namespace penumbra::runtime
