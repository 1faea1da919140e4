// SPDX-License-Identifier: MIT
// Shows that a device computes: atomics, fused multiply-add, vectors, rounding conversions.
#include "lib/lanes.h"
#include "shared/portable.h"

/// results: [0] maximum over items of a hashed index, [1] items counted, [2] fma exactness, [3] lanes
kernel void self_test(const int items, volatile global uint* results) {
    const int i = get_global_id(0);
    if (i >= items) return;
    atomic_max(&results[0], as_uint((float)((i * 37) % items) + 0.5f));
#ifndef SELF_TEST_BROKEN  // tests define it, to see a device refused
    atomic_inc(&results[1]);
#endif
    if (i != 0) return;
    const float tiny = 1.0f / 4096.0f;
    // (1 + t)^2 - 1 - 2t = t^2 only if the product is not rounded
    results[2] = fma(1.0f + tiny, 1.0f + tiny, -1.0f - 2.0f * tiny) == tiny * tiny;
    const VF ramp = V_TO_FLOAT(V_INDEX) * 2.0f + 1.0f;
    results[3] = V_ALL(V_MASK(ramp > 0.0f)) && convert_int_rte(2.5f) == 2;
}
