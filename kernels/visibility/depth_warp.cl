// SPDX-License-Identifier: MIT
// Warps points into the depth maps of a light's views, keeping the nearest surface per texel.
//   points --two multiply-adds per view--> texel --maximum of depth bits--> depth maps
// Source: [VWSS] 3.2. depth_warp is its compute shader; serial, partial and full differ in the views
// per launch. depth_warp_owned gives each map to one work-item, which needs no atomics: the better form
// where work-items are few and atomics are slow (CPUs). All variants give the same maps bit for bit.
#include "lib/lanes.h"

typedef struct {
    VF a, b, w;
} PointLanes;

inline PointLanes loadPoints(const MultiViewParams* p, uint first, global const float* restrict points32,
                             global const ushort* restrict points16) {
    const size_t c = p->pointCapacity;
    PointLanes lanes;
    if (p->precision == POINTS_FLOAT) {
        lanes.a = V_LOAD(points32, first);
        lanes.b = V_LOAD(points32, c + first);
        lanes.w = V_LOAD(points32, 2 * c + first);
    } else if (p->precision == POINTS_HALF) {
        global const half* halves = (global const half*)points16;
        lanes.a = V_LOAD_HALF(halves, first) + p->centre;
        lanes.b = V_LOAD_HALF(halves, c + first) + p->centre;
        lanes.w = V_LOAD_HALF(halves, 2 * c + first);
    } else {
        const float extent = fixedExtent(p), low = p->centre - 0.5f * extent, step = extent / 65535.0f;
        lanes.a = V_TO_FLOAT(V_LOAD(points16, first)) * step + low;
        lanes.b = V_TO_FLOAT(V_LOAD(points16, c + first)) * step + low;
        lanes.w = V_TO_FLOAT(V_LOAD(points16, 2 * c + first)) * (1.0f / 65535.0f);
    }
    return lanes;
}

inline float3 loadPoint(const MultiViewParams* p, uint slot, global const float* restrict points32,
                        global const ushort* restrict points16) {
    const size_t c = p->pointCapacity;
    if (p->precision == POINTS_FLOAT)
        return (float3)(points32[slot], points32[c + slot], points32[2 * c + slot]);
    if (p->precision == POINTS_HALF) {
        global const half* halves = (global const half*)points16;
        return (float3)(vload_half(slot, halves) + p->centre, vload_half(c + slot, halves) + p->centre,
                        vload_half(2 * c + slot, halves));
    }
    const float extent = fixedExtent(p), low = p->centre - 0.5f * extent, step = extent / 65535.0f;
    return (float3)((float)points16[slot] * step + low, (float)points16[c + slot] * step + low,
                    (float)points16[2 * c + slot] * (1.0f / 65535.0f));
}

/// Work-items take points in turn; each splats to the views [firstView, firstView + viewCount).
/// samples  [view, 2]   kx, ky
/// maps     [view, row, column]  depth bits, 32 bits a texel; cleared to 0 by the host
kernel void depth_warp(const MultiViewParams params, const LookupParams views,
                       global const float* restrict points32, global const ushort* restrict points16,
                       global const uint* restrict keys, global const float* restrict samples,
                       volatile global uint* maps, global const MultiViewCounters* restrict counters) {
    const uint count = min(counters->points, params.pointCapacity);
    for (uint slot = get_global_id(0); slot < count; slot += get_global_size(0)) {
        const float3 point = loadPoint(&params, slot, points32, points16);
        splatPoint(&params, &views, point, params.alphaKeys ? keys[slot] : 0, samples, maps);
    }
}

// The owned forms differ in the map's texel type alone
#define OWNED_TEXEL uint
#define OWNED_KERNEL depth_warp_owned
#include "visibility/depth_warp_owned.inl"
#define OWNED_TEXEL ushort
#define OWNED_KERNEL depth_warp_owned16
#include "visibility/depth_warp_owned.inl"
