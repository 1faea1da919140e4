// SPDX-License-Identifier: MIT
// Turns triangles into points, seen from an enlarged central view that holds all views of the light.
//   triangles --enlarged view, no depth test--> fragments --> points (buffered)
//                                                        --> all depth maps at once (unbuffered)
// Source: [VWSS] 3.1, equations 1-3 (enlarged view), 3 (buffered and unbuffered).
// Differs: points are kept as (a, b, w) of shared/multi_view.h instead of world positions, so that a view
// costs two multiply-adds; fragments go through a work-item's own buffer, one global atomic a flush.
#include "lib/atomics.h"
#include "lib/caster_opacity.h"
#include "lib/opacity.h"
#include "lib/raster.h"
#include "shared/multi_view.h"

#ifndef POINT_BUFFER  // points that a work-item keeps before it appends them all; 1: an atomic per fragment
#ifdef ON_CPU
#define POINT_BUFFER 256
#else
#define POINT_BUFFER 4
#endif
#endif

/// A fragment of the enlarged view as (a, b, w).
inline float3 pointOf(const MultiViewParams* p, int x, int y, float depth) {
    const float fromEye = (p->nearClip + p->setBack) / depth;
    const float z = max(fromEye - p->setBack, p->nearClip);
    const float ratio = fromEye / z * ((float)p->resolution / (float)p->enlarged);
    const float half_ = 0.5f * (float)p->enlarged;
    return (float3)(fma((float)x + 0.5f - half_, ratio, p->centre),
                    fma((float)y + 0.5f - half_, ratio, p->centre), p->near / z);
}

/// Texels that the views span together, about the centre: what fixed-point coordinates range over. At
/// density 1 this is the enlarged view's size, but points lie as far out at any other density.
inline float fixedExtent(const MultiViewParams* p) {
    return (float)p->resolution * (1.0f + p->setBack / p->near);
}

inline ushort pointToFixed(float value, float low, float extent) {
    return (ushort)clamp(fma((value - low) / extent, 65535.0f, 0.5f), 0.0f, 65535.0f);
}

/// Stores a point in the precision asked for: points32 [3, capacity] float, or points16 [3, capacity]
/// half or fixed point.
inline void storePoint(const MultiViewParams* p, uint slot, float3 point, global float* points32,
                       global ushort* points16) {
    const uint c = p->pointCapacity;
    if (p->precision == POINTS_FLOAT) {
        points32[slot] = point.x;
        points32[c + slot] = point.y;
        points32[2 * c + slot] = point.z;
    } else if (p->precision == POINTS_HALF) {
        global half* halves = (global half*)points16;
        vstore_half_rte(point.x - p->centre, slot, halves);
        vstore_half_rte(point.y - p->centre, c + slot, halves);
        vstore_half_rte(point.z, 2 * c + slot, halves);
    } else {
        const float extent = fixedExtent(p), low = p->centre - 0.5f * extent;
        points16[slot] = pointToFixed(point.x, low, extent);
        points16[c + slot] = pointToFixed(point.y, low, extent);
        points16[2 * c + slot] = pointToFixed(point.z, 0.0f, 1.0f);
    }
}

#define RASTER_KERNEL points
#define RASTER_KERNEL_LARGE points_large
#define RASTER_PARAMETERS                                                                         \
    CASTER_ALPHA_PARAMETERS, const MultiViewParams params, global float *restrict points32,        \
        global ushort *restrict points16, global uint *restrict keys,                             \
        volatile global MultiViewCounters *counters
#define RASTER_BEGIN              \
    float3 kept[POINT_BUFFER];    \
    uint keptKeys[POINT_BUFFER];  \
    uint pending = 0, nearCount = 0;
#define POINTS_FLUSH                                                          \
    {                                                                         \
        const uint slot = atomic_add(&counters->points, pending);              \
        for (uint i = 0; i < pending; ++i)                                      \
            if (slot + i < params.pointCapacity) {                            \
                storePoint(&params, slot + i, kept[i], points32, points16);   \
                if (params.alphaKeys) keys[slot + i] = keptKeys[i];           \
            }                                                                 \
        pending = 0;                                                           \
    }
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT                                                                              \
    const float opacity = casterOpacity(&draw, materials, indices, uvs, colours, texels, triangle,   \
                                        v, x, y);                                                    \
    if (opacity > 0.0f) {                                                                            \
        kept[pending] = pointOf(&params, x, y, depth);                                                 \
        nearCount += kept[pending].z > 1.0f;                                                           \
        keptKeys[pending] = opacityKey(opacity, drawIndex);                                            \
        if (++pending == POINT_BUFFER) POINTS_FLUSH                                                    \
    }
#define RASTER_END                                              \
    if (pending) POINTS_FLUSH                                     \
    if (nearCount) atomic_add(&counters->nearPoints, nearCount);
#include "lib/raster.inl"

/// Splats one point to the views [firstView, firstView + viewCount) of 32-bit maps.
inline void splatPoint(const MultiViewParams* p, const LookupParams* views, float3 point, uint key,
                       global const float* restrict samples, volatile global uint* maps) {
    const float size = (float)p->resolution, depth = min(point.z, 1.0f);
    const uint bits = p->depthBits == 32 ? as_uint(depth) : (uint)fma(depth, 65535.0f, 0.5f);
    for (int i = 0; i < views->viewCount; ++i) {
        const int view = views->firstView + i;
        const float u = fma(-samples[2 * view], point.z, point.x);
        const float v = fma(-samples[2 * view + 1], point.z, point.y);
        if (!(u >= 0.0f && u < size && v >= 0.0f && v < size)) continue;
        if (p->alphaKeys && !opacityBlocks(key, view, p->views, p->sampleStride)) continue;
        volatile global uint* texel = &maps[(size_t)(view - views->mapView) * p->mapStride +
                                            (uint)v * (uint)p->resolution + (uint)u];
        ATOMIC_MAX_EARLY(texel, bits)
    }
}

#define RASTER_KERNEL points_direct
#define RASTER_KERNEL_LARGE points_direct_large
#define RASTER_PARAMETERS                                                                       \
    CASTER_ALPHA_PARAMETERS, const MultiViewParams params, const LookupParams lookup,            \
        global const float *restrict samples, volatile global uint *maps,                       \
        volatile global MultiViewCounters *counters
#define RASTER_BEGIN uint pointCount = 0, nearCount = 0;
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT                                                                              \
    const float opacity = casterOpacity(&draw, materials, indices, uvs, colours, texels, triangle,   \
                                        v, x, y);                                                    \
    if (opacity > 0.0f) {                                                                            \
        const float3 point = pointOf(&params, x, y, depth);                                          \
        ++pointCount;                                                                                \
        nearCount += point.z > 1.0f;                                                                 \
        splatPoint(&params, &lookup, point, opacityKey(opacity, drawIndex), samples, maps);          \
    }
#define RASTER_END                                                     \
    if (pointCount && lookup.firstView == 0) { /* once, not per traversal */ \
        atomic_add(&counters->points, pointCount);                     \
        atomic_add(&counters->nearPoints, nearCount);                  \
    }
#include "lib/raster.inl"
