// SPDX-License-Identifier: MIT
// Planes of the G-buffer: float [GB_PLANES, height + fragment rows, width], padded to GB_PAD pixels a plane.
// Rows below the image hold its blended fragments, in the order of shared/abuffer.h: they are shaded as pixels.
#ifndef SHARED_GBUFFER_H
#define SHARED_GBUFFER_H
#include "shared/portable.h"
SHARED_BEGIN

#define GB_POSITION 0    // 3: world, re-based, metres
#define GB_GEOMETRIC 3   // 3: unit normal of the triangle, on the side that the camera sees
#define GB_NORMAL 6      // 3: unit shading normal, on the camera's side
#define GB_ALBEDO 9      // 3: linear; of what is not transmitted
#define GB_METALLIC 12
#define GB_ROUGHNESS 13
#define GB_EMISSIVE 14   // 3: linear; unlit colour for unlit surfaces, whose albedo is 0
#define GB_DEPTH 17      // camera depth, metres; +inf: background
#define GB_OBJECT 18     // uint bits: object of the draw; 0: background
#define GB_FLAGS 19      // uint bits: DRAW_* of the draw
#define GB_PREVIOUS 20   // 3: the point's position in the last frame
#define GB_PLANES 23
#define GB_PAD 16        // planes start at multiples of this many pixels

/// Floats between planes of `pixels` pixels: whole vectors, and a multiple of 4 KiB plus 5 cache lines, so
/// that the planes of a pixel do not all fall into the same sets of a cache.
inline int gbufferStride(int pixels) {
    return (pixels + 1023) / 1024 * 1024 + 80;
}

typedef struct {
    float4 eye;       ///< world, re-based; w = 1, or w = 0: direction towards the viewer (orthographic)
    float4 rowDepth;  ///< camera depth = dot(rowDepth, (p, 1))
    int width, height;  ///< of the image
    int planeStride;  ///< floats between planes
    int idStride;     ///< words between pixels of the visibility buffer: 1, or 2 with 64-bit atomics
    int hasPrevious;  ///< 0: the last frame's positions are those of this frame
    uint fragmentCapacity;  ///< of the A-buffer; 0: the scene has no blended surfaces
    int unused[2];
} GBufferParams;
SHARED_STRUCT(GBufferParams, 64)

SHARED_END
#endif
