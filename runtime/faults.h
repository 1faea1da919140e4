// SPDX-License-Identifier: MIT
// What tests make go wrong on a device. Nothing of it happens unless a test asks for it.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace penumbra::runtime {

/// Lets a number of calls pass and fails all that follow, until it is put off again.
class Fault {
  public:
    void after(std::uint64_t calls) { left_ = calls; }
    void never() { left_.reset(); }
    /// Counts a call; true if it is to fail.
    bool strikes() {
        if (!left_ || *left_ == 0) return left_.has_value();
        --*left_;
        return false;
    }
    /// True once a call has failed, without counting one.
    bool struck() const { return left_ && *left_ == 0; }

  private:
    std::optional<std::uint64_t> left_;
};

struct Faults {
    Fault allocation;  ///< counts buffers: the driver has no more memory
    Fault loss;        ///< counts launches of kernels: the device is gone
    /// Program -> more "NAME=VALUE" to build it with, so that it does not, or fails its test.
    std::map<std::string, std::vector<std::string>> defines;
    /// Lists whose length only the device knows begin with at most so many entries.
    std::uint64_t firstCapacity = ~0ULL;
};

}  // namespace penumbra::runtime
