// SPDX-License-Identifier: MIT
// Points and small vectors.
#ifndef LIB_TRANSFORM_H
#define LIB_TRANSFORM_H
#include "shared/portable.h"

inline float dotPoint(float4 row, float x, float y, float z) {
    return fma(row.x, x, fma(row.y, y, fma(row.z, z, row.w)));
}

inline float dotVector(float4 row, float x, float y, float z) {
    return fma(row.x, x, fma(row.y, y, row.z * z));
}

inline float3 load3(global const float* values, uint index) {
    return (float3)(values[3 * index], values[3 * index + 1], values[3 * index + 2]);
}

inline float3 normalizeOr(float3 v, float3 fallback) {
    const float squared = fma(v.x, v.x, fma(v.y, v.y, v.z * v.z));
    return squared > 1e-30f ? v / sqrt(squared) : fallback;
}

inline float3 cross3(float3 a, float3 b) {
    return (float3)(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

#endif
