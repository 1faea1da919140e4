// SPDX-License-Identifier: MIT
// The alpha test of the G-buffer's fragments: MASK by its cutoff; BLEND as opaque where alpha > 0.5.
#ifndef GBUFFER_ALPHA_H
#define GBUFFER_ALPHA_H
#include "lib/atomics.h"

#define GBUFFER_ALPHA_PARAMETERS                                                        \
    , global const Material* restrict materials, global const float* restrict uvs,      \
        global const uint* restrict colours, global const uint* restrict texels

#define GBUFFER_ALPHA_PASSES                                                                        \
    (!(draw.flags & (DRAW_MASK | DRAW_BLEND)) ||                                                    \
     gbufferAlphaPasses(&draw, &materials[draw.material], indices, uvs, colours, texels, triangle,  \
                        rasterBarycentrics(v, x, y)))

inline int gbufferAlphaPasses(const Draw* draw, global const Material* material,
                              global const uint* indices, global const float* restrict uvs,
                              global const uint* restrict colours, global const uint* restrict texels,
                              uint triangle, float3 barycentrics) {
    const float alpha =
        surfaceAlpha(draw, material, indices, uvs, colours, texels, triangle, barycentrics);
    return draw->flags & DRAW_MASK ? alpha >= material->alphaCutoff : alpha > 0.5f;
}

#endif
