// SPDX-License-Identifier: MIT
// One pass of a stable radix sort: digits of 8 bits. A work-item owns a chunk of consecutive keys, so
// that the order of equal keys is kept without communication.
#include "shared/portable.h"

#define SORT_DIGITS 256

/// histogram [digit, chunk]: how often each digit occurs in each chunk.
kernel void sort_count(const uint count, const uint chunk, const uint chunks, const uint shift,
                       global const uint* restrict keys, global uint* restrict histogram) {
    const uint item = get_global_id(0);
    if (item >= chunks) return;
    for (uint d = 0; d < SORT_DIGITS; ++d) histogram[d * chunks + item] = 0;
    const uint begin = min(item * chunk, count), end = min(begin + chunk, count);
    for (uint i = begin; i < end; ++i) histogram[((keys[i] >> shift) & 255) * chunks + item] += 1;
}

/// `offsets` is the scanned histogram; it is used up.
kernel void sort_scatter(const uint count, const uint chunk, const uint chunks, const uint shift,
                         global const uint* restrict keys, global const uint* restrict values,
                         global uint* restrict offsets, global uint* restrict sortedKeys,
                         global uint* restrict sortedValues) {
    const uint item = get_global_id(0);
    if (item >= chunks) return;
    const uint begin = min(item * chunk, count), end = min(begin + chunk, count);
    for (uint i = begin; i < end; ++i) {
        const uint key = keys[i];
        const uint slot = offsets[((key >> shift) & 255) * chunks + item]++;
        sortedKeys[slot] = key;
        sortedValues[slot] = values[i];
    }
}
