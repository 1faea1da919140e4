// SPDX-License-Identifier: MIT
// Stable radix sort of (key, value) pairs on the device.
#pragma once
#include <cstdint>

#include "runtime/kernel.h"
#include "runtime/scan.h"

namespace penumbra::runtime {

class Sort {
  public:
    explicit Sort(const Program& frame);
    /// Sorts keys [count] ascending and moves values [count] along; pairs of equal keys keep their
    /// order. Only the lowest `bits` of the keys count (1 to 32). Enqueues; allocates scratch when
    /// count grows. Kernels: kernels/runtime/sort.cl
    void run(Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, std::uint32_t count,
             int bits = 32);

  private:
    static constexpr std::uint32_t kDigits = 256, kChunks = 256;
    using U32 = std::uint32_t;
    Device* device_;
    Scan scan_;
    Kernel<U32, U32, U32, U32, Buffer<U32>, Buffer<U32>> count_;
    Kernel<U32, U32, U32, U32, Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<U32>>
        scatter_;
    Buffer<U32> histogram_, total_, otherKeys_, otherValues_;
};

}  // namespace penumbra::runtime
