// SPDX-License-Identifier: MIT
// Random points of a light, of their own for each (pixel, sample, seed).
#ifndef LIB_RANDOM_SAMPLES_H
#define LIB_RANDOM_SAMPLES_H
#include "lib/lanes.h"
#include "shared/raytrace.h"

/// The next number of a PCG hash per lane, in (0, 1).
inline VF randomNext(VU* state) {
    *state = *state * 747796405u + 2891336453u;
    const VU word = ((*state >> ((*state >> 28) + 4u)) ^ *state) * 277803737u;
    return fma(V_TO_FLOAT(V_AS_INT(((word >> 22) ^ word) >> 9)), (VF)(1.0f / 8388608.0f), (VF)(0.5f / 8388608.0f));
}

/// Points of the square, or where the light is a disk, rejected until inside; the last try is pulled in.
inline void randomSamples(const RaytraceParams* p, int pixel, VI index, VF* x, VF* y, VF* z) {
    VU state = V_AS_UINT(index) * 0x9e3779b1u + (uint)pixel * 0x85ebca77u + as_uint(p->centre.w) * 0xc2b2ae3du;
    randomNext(&state);
    VF u = fma(randomNext(&state), (VF)2.0f, (VF)-1.0f), v = fma(randomNext(&state), (VF)2.0f, (VF)-1.0f);
    for (int i = 0; i < 24 && p->shape == RAY_SAMPLES_DISK; ++i) {
        const VI outside = V_MASK(fma(u, u, v * v) > 1.0f);
        if (!V_ANY(outside)) break;
        u = V_SELECT(u, fma(randomNext(&state), (VF)2.0f, (VF)-1.0f), outside);
        v = V_SELECT(v, fma(randomNext(&state), (VF)2.0f, (VF)-1.0f), outside);
    }
    if (p->shape == RAY_SAMPLES_DISK) {
        const VF shrink = 1.0f / sqrt(max(fma(u, u, v * v), (VF)1.0f));
        u *= shrink;
        v *= shrink;
    }
    *x = fma(u, (VF)p->axisX.x, fma(v, (VF)p->axisY.x, (VF)p->centre.x));
    *y = fma(u, (VF)p->axisX.y, fma(v, (VF)p->axisY.y, (VF)p->centre.y));
    *z = fma(u, (VF)p->axisX.z, fma(v, (VF)p->axisY.z, (VF)p->centre.z));
}

#endif
