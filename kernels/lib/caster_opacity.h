// SPDX-License-Identifier: MIT
// Opacity of a caster's fragment, for techniques that rasterise casters from the light.
#ifndef LIB_CASTER_OPACITY_H
#define LIB_CASTER_OPACITY_H
#include "lib/raster.h"
#include "lib/texture.h"

#define CASTER_ALPHA_PARAMETERS                                                     \
    , global const Material* restrict materials, global const float* restrict uvs,  \
        global const uint* restrict colours, global const uint* restrict texels

/// 0 where the alpha test fails, 1 for opaque draws. `v`: the vertices before clipping.
inline float casterOpacity(const Draw* draw, global const Material* materials,
                           global const uint* indices, global const float* restrict uvs,
                           global const uint* restrict colours, global const uint* restrict texels,
                           uint triangle, const RasterVertex* v, int x, int y) {
    if (!(draw->flags & (DRAW_MASK | DRAW_BLEND))) return 1.0f;
    global const Material* material = &materials[draw->material];
    const float alpha = surfaceAlpha(draw, material, indices, uvs, colours, texels, triangle,
                                     rasterBarycentrics(v, x, y));
    if (draw->flags & DRAW_MASK) return alpha >= material->alphaCutoff ? 1.0f : 0.0f;
    return alpha * (1.0f - material->transmission);
}

#endif
