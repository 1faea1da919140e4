// SPDX-License-Identifier: MIT
// Nearest triangle per pixel in one pass, for devices with 64-bit atomics.
// visibility  [height, width, 2]  as ulong: depth bits << 32 | ~triangle, cleared to 0; uint* so that
//             the resolve pass reads the same buffer (little-endian: the triangle comes first)
#pragma OPENCL EXTENSION cl_khr_int64_extended_atomics : enable
#include "gbuffer/gbuffer_alpha.h"

#define RASTER_KERNEL gbuffer_raster64
#define RASTER_KERNEL_LARGE gbuffer_raster64_large
#define RASTER_PARAMETERS GBUFFER_ALPHA_PARAMETERS, volatile global uint* visibility
#define RASTER_BEGIN
#define RASTER_TRIANGLE
#ifdef RACE_CHECKED
#define LOOK_FIRST(texel, value) 1
#else
#define LOOK_FIRST(texel, value) (*(texel) < (value))
#endif
#define RASTER_FRAGMENT                                                             \
    volatile global ulong* texel =                                                  \
        (volatile global ulong*)visibility + (y * view.width + x);                  \
    const ulong value = (ulong)as_uint(depth) << 32 | (ulong)~triangle;             \
    if (LOOK_FIRST(texel, value) && GBUFFER_ALPHA_PASSES) atom_max(texel, value);
#define RASTER_END
#include "lib/raster.inl"
