// SPDX-License-Identifier: MIT
// Nearest triangle per pixel with 32-bit atomics: first the largest (nearest) depth, then, among the
// triangles of that depth, the lowest index. Both passes compute a fragment's depth alike.
// depthBits  [height, width]  float bits, cleared to 0
// ids        [height, width]  ~triangle, cleared to 0
#include "gbuffer/gbuffer_alpha.h"

#define RASTER_KERNEL gbuffer_depth
#define RASTER_KERNEL_LARGE gbuffer_depth_large
#define RASTER_PARAMETERS GBUFFER_ALPHA_PARAMETERS, volatile global uint* depthBits
#define RASTER_BEGIN
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT                                                        \
    if (GBUFFER_ALPHA_PASSES) {                                                \
        volatile global uint* texel = &depthBits[y * view.width + x];          \
        const uint bits = as_uint(depth);                                      \
        ATOMIC_MAX_EARLY(texel, bits)                                          \
    }
#define RASTER_END
#include "lib/raster.inl"

#define RASTER_KERNEL gbuffer_id
#define RASTER_KERNEL_LARGE gbuffer_id_large
#define RASTER_PARAMETERS \
    GBUFFER_ALPHA_PARAMETERS, global const uint* restrict depthBits, volatile global uint* ids
#define RASTER_BEGIN
#define RASTER_TRIANGLE
#define RASTER_FRAGMENT                                             \
    if (as_uint(depth) == depthBits[y * view.width + x] &&          \
        GBUFFER_ALPHA_PASSES)                                       \
        atomic_max(&ids[y * view.width + x], ~triangle);
#define RASTER_END
#include "lib/raster.inl"
