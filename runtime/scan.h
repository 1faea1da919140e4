// SPDX-License-Identifier: MIT
// Exclusive prefix sum on the device.
#pragma once
#include <cstdint>

#include "runtime/kernel.h"

namespace penumbra::runtime {

class Scan {
  public:
    explicit Scan(const Program& frame);
    /// Replaces values [count] by their exclusive prefix sum; total [1] receives the sum (modulo
    /// 2^32). count may be 0. Enqueues only. Kernels: kernels/runtime/scan.cl
    void run(Buffer<std::uint32_t>& values, std::uint32_t count, Buffer<std::uint32_t>& total);

  private:
    static constexpr std::uint32_t kChunks = 1024;  ///< at most; sums are scanned by one work-item
    Kernel<std::uint32_t, std::uint32_t, Buffer<std::uint32_t>, Buffer<std::uint32_t>> sum_;
    Kernel<std::uint32_t, Buffer<std::uint32_t>, Buffer<std::uint32_t>> sums_;
    Kernel<std::uint32_t, std::uint32_t, Buffer<std::uint32_t>, Buffer<std::uint32_t>> apply_;
    Buffer<std::uint32_t> partial_;
};

}  // namespace penumbra::runtime
