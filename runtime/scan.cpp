// SPDX-License-Identifier: MIT
#include "runtime/scan.h"

#include <algorithm>

namespace penumbra::runtime {

Scan::Scan(const Program& frame)
    : sum_(frame, "scan_sum"),
      sums_(frame, "scan_sums"),
      apply_(frame, "scan_apply"),
      partial_(frame.device(), "scan sums", kChunks) {}

void Scan::run(Buffer<std::uint32_t>& values, std::uint32_t count, Buffer<std::uint32_t>& total) {
    const std::uint32_t chunk = std::max((count + kChunks - 1) / kChunks, 64U);
    const std::uint32_t chunks = (count + chunk - 1) / chunk;
    sum_.launch({chunks}, {16}, count, chunk, values, partial_);
    sums_.launch({1}, {1}, chunks, partial_, total);
    apply_.launch({chunks}, {16}, count, chunk, values, partial_);
}

}  // namespace penumbra::runtime
