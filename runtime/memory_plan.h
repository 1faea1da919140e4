// SPDX-License-Identifier: MIT
// What will be allocated, checked against the device's limits before the first frame.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/device.h"

namespace penumbra::runtime {

class MemoryPlan {
  public:
    explicit MemoryPlan(const Device& device) : device_(&device) {}
    void add(const std::string& label, std::uint64_t bytes);
    /// Adds what the device holds by now, in buffers of any size.
    void addHeld(const std::string& label);
    std::uint64_t plannedBytes() const;
    /// What is left for buffers that adapt their size (batches of views): the device's limit less
    /// what is planned, less a tenth for the driver.
    std::uint64_t freeBytes() const;
    /// Throws Error (exit code 4) naming the largest entries when the plan does not fit.
    void check() const;

  private:
    struct Entry {
        std::string label;
        std::uint64_t bytes;
        bool oneBuffer;
    };
    const Device* device_;
    std::vector<Entry> entries_;
};

}  // namespace penumbra::runtime
