// SPDX-License-Identifier: MIT
// Exclusive prefix sum in place: sums of chunks, scan of the sums, scan within the chunks.
// A work-item scans a chunk serially, which suits CPUs and is within a small factor on GPUs.
#include "shared/portable.h"

/// sums [chunks]: the sum of values [i * chunk, (i + 1) * chunk).
kernel void scan_sum(const uint count, const uint chunk, global const uint* restrict values,
                     global uint* restrict sums) {
    const uint item = get_global_id(0);
    const uint begin = min(item * chunk, count), end = min(begin + chunk, count);
    if (begin >= count) return;
    uint sum = 0;
    for (uint i = begin; i < end; ++i) sum += values[i];
    sums[item] = sum;
}

/// One work-item: scans sums in place and writes the total.
kernel void scan_sums(const uint chunks, global uint* restrict sums, global uint* restrict total) {
    if (get_global_id(0) != 0) return;
    uint sum = 0;
    for (uint i = 0; i < chunks; ++i) {
        const uint value = sums[i];
        sums[i] = sum;
        sum += value;
    }
    *total = sum;
}

kernel void scan_apply(const uint count, const uint chunk, global uint* restrict values,
                       global const uint* restrict sums) {
    const uint item = get_global_id(0);
    const uint begin = min(item * chunk, count), end = min(begin + chunk, count);
    if (begin >= count) return;
    uint sum = sums[item];
    for (uint i = begin; i < end; ++i) {
        const uint value = values[i];
        values[i] = sum;
        sum += value;
    }
}
