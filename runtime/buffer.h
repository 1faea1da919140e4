// SPDX-License-Identifier: MIT
// Typed device memory with a shape.
#pragma once
#include <cassert>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "runtime/device.h"

namespace cl {
class Buffer;
}

namespace penumbra::runtime {

/// Untyped device memory; see Buffer. Zero bytes are allowed and hold no memory of the device.
class Memory {
  public:
    Memory() = default;
    Memory(Device& device, std::string label, std::uint64_t bytes);
    ~Memory();
    Memory(Memory&& other) noexcept;
    Memory& operator=(Memory&& other) noexcept;

    Device& device() const { return *device_; }
    const std::string& label() const { return label_; }
    std::uint64_t bytes() const { return bytes_; }
    const cl::Buffer& handle() const { return *buffer_; }
    bool allocated() const { return buffer_ != nullptr; }

    void write(const void* data, std::uint64_t offset, std::uint64_t bytes);  ///< waits
    void stage(std::shared_ptr<const void> data, std::uint64_t bytes);        ///< does not wait
    void read(void* data, std::uint64_t offset, std::uint64_t bytes) const;   ///< waits
    void fill(const void* pattern, std::size_t patternBytes, std::uint64_t bytes);  ///< enqueues
    void copyFrom(const Memory& source, std::uint64_t bytes);                       ///< enqueues

  private:
    void release();
    Device* device_ = nullptr;
    std::string label_;
    std::uint64_t bytes_ = 0;
    std::shared_ptr<cl::Buffer> buffer_;
};

/// Extent of an array, slowest axis first: [planes, rows, columns].
struct Shape {
    std::uint64_t planes = 1, rows = 1, columns = 0;
    std::uint64_t count() const { return planes * rows * columns; }
    bool operator==(const Shape&) const = default;
};

/// Array of T on the device. Owns its memory; movable. Contents are undefined until written.
template <typename T>
class Buffer {
  public:
    using Element = T;
    Buffer() = default;
    /// Throws Error (exit code 4, with the figures) when the device cannot hold it.
    Buffer(Device& device, const std::string& label, std::uint64_t count)
        : Buffer(device, label, Shape{1, 1, count}) {}
    Buffer(Device& device, const std::string& label, Shape shape)
        : memory_(device, label, shape.count() * sizeof(T)), shape_(shape) {}
    Buffer(Device& device, const std::string& label, const std::vector<T>& values)
        : Buffer(device, label, values.size()) {
        upload(values);
    }

    std::uint64_t count() const { return shape_.count(); }
    const Shape& shape() const { return shape_; }
    std::uint64_t bytes() const { return memory_.bytes(); }
    const Memory& memory() const { return memory_; }
    bool allocated() const { return memory_.allocated(); }

    /// Makes room for at least `count` elements; contents are lost when it grows. Never shrinks.
    void grow(Device& device, const std::string& label, std::uint64_t count) {
        if (memory_.allocated() && shape_.count() >= count) return;
        memory_ = Memory();  // free first: both at once may not fit
        *this = Buffer(device, label, count);
    }

    /// Copies to the device and waits.
    void upload(const std::vector<T>& values) {
        assert(values.size() <= count());
        memory_.write(values.data(), 0, values.size() * sizeof(T));
    }
    /// Enqueues a copy to the device; the values live on until the device's next finish().
    void uploadLater(std::vector<T> values) {
        assert(values.size() <= count());
        const auto bytes = values.size() * sizeof(T);
        auto kept = std::make_shared<std::vector<T>>(std::move(values));
        memory_.stage(std::shared_ptr<const void>(kept, kept->data()), bytes);
    }
    /// Waits for the device and copies elements [first, first + n) back; n = all by default.
    std::vector<T> download(std::uint64_t first = 0, std::uint64_t n = ~0ULL) const {
        if (n == ~0ULL) n = count() - first;
        assert(first + n <= count());
        std::vector<T> values(n);
        memory_.read(values.data(), first * sizeof(T), n * sizeof(T));
        return values;
    }
    /// Enqueues setting the first n elements (all by default).
    void fill(const T& value, std::uint64_t n = ~0ULL) {
        memory_.fill(&value, sizeof(T), (n == ~0ULL ? count() : n) * sizeof(T));
    }
    void copyFrom(const Buffer& source, std::uint64_t n) {
        memory_.copyFrom(source.memory_, n * sizeof(T));
    }

  private:
    Memory memory_;
    Shape shape_;
};

}  // namespace penumbra::runtime
