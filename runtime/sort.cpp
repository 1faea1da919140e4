// SPDX-License-Identifier: MIT
#include "runtime/sort.h"

#include <algorithm>
#include <utility>

namespace penumbra::runtime {

Sort::Sort(const Program& frame)
    : device_(&frame.device()),
      scan_(frame),
      count_(frame, "sort_count"),
      scatter_(frame, "sort_scatter"),
      histogram_(frame.device(), "sort histogram", kDigits * kChunks),
      total_(frame.device(), "sort total", 1) {}

void Sort::run(Buffer<U32>& keys, Buffer<U32>& values, U32 count, int bits) {
    if (count < 2) return;
    otherKeys_.grow(*device_, "sorted keys", count);
    otherValues_.grow(*device_, "sorted values", count);
    const U32 chunk = std::max((count + kChunks - 1) / kChunks, 256U);
    const U32 chunks = (count + chunk - 1) / chunk;
    Buffer<U32>*fromKeys = &keys, *fromValues = &values;
    Buffer<U32>*toKeys = &otherKeys_, *toValues = &otherValues_;
    for (U32 shift = 0; shift < static_cast<U32>(bits); shift += 8) {
        count_.launch({chunks}, {16}, count, chunk, chunks, shift, *fromKeys, histogram_);
        scan_.run(histogram_, kDigits * chunks, total_);
        scatter_.launch({chunks}, {16}, count, chunk, chunks, shift, *fromKeys, *fromValues,
                        histogram_, *toKeys, *toValues);
        std::swap(fromKeys, toKeys);
        std::swap(fromValues, toValues);
    }
    if (fromKeys == &keys) return;
    keys.copyFrom(*fromKeys, count);
    values.copyFrom(*fromValues, count);
}

}  // namespace penumbra::runtime
