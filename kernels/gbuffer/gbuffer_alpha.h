// SPDX-License-Identifier: MIT
// Which fragments the camera sees as opaque, and which it blends: MASK is tested by its cutoff; BLEND is
// opaque where its alpha is 1, nothing where it is 0, and blended between; what transmits is blended.
#ifndef GBUFFER_ALPHA_H
#define GBUFFER_ALPHA_H
#include "gbuffer/surface_colour.h"
#include "lib/atomics.h"

#define GBUFFER_ALPHA_PARAMETERS                                                        \
    , global const Material* restrict materials, global const float* restrict uvs,      \
        global const uint* restrict colours, global const uint* restrict texels

#define GBUFFER_ALPHA_PASSES                                                                        \
    (!(draw.flags & (DRAW_MASK | DRAW_BLEND)) ||                                                    \
     gbufferAlphaPasses(&draw, &materials[draw.material], indices, uvs, colours, texels, triangle, v, x, y))
#define GBUFFER_ALPHA_BLENDS \
    gbufferAlphaBlends(&draw, &materials[draw.material], indices, uvs, colours, texels, triangle, v, x, y)

/// Alpha of a blended surface at the texture level of the pixel's footprint.
inline float blendAlpha(const Draw* draw, global const Material* material, global const uint* indices,
                        global const float* restrict uvs, global const uint* restrict colours,
                        global const uint* restrict texels, uint triangle, const RasterVertex* v, int x, int y) {
    if (material->flags & MATERIAL_OPAQUE) return 1.0f;
    if (material->baseColorTexture.offset < 0 && !(draw->flags & DRAW_COLOURS)) return material->baseColor.w;
    const SurfacePoint p = surfacePoint(draw, indices, uvs, triangle, v, x, y);
    return surfaceColour(draw, material, &p, colours, texels).w;
}

/// 1 if the alpha need not be read to tell; vertex colours may change it.
inline int alwaysBlends(const Draw* draw, global const Material* material) {
    return (material->flags & MATERIAL_BLENDS) && !(draw->flags & DRAW_COLOURS);
}

inline int gbufferAlphaPasses(const Draw* draw, global const Material* material, global const uint* indices,
                              global const float* restrict uvs, global const uint* restrict colours,
                              global const uint* restrict texels, uint triangle, const RasterVertex* v, int x,
                              int y) {
    if (draw->flags & DRAW_MASK)
        return surfaceAlpha(draw, material, indices, uvs, colours, texels, triangle, rasterBarycentrics(v, x, y)) >=
               material->alphaCutoff;
    if (alwaysBlends(draw, material)) return 0;
    return material->transmission == 0.0f &&
           blendAlpha(draw, material, indices, uvs, colours, texels, triangle, v, x, y) >= BLEND_OPAQUE_ALPHA;
}

inline int gbufferAlphaBlends(const Draw* draw, global const Material* material, global const uint* indices,
                              global const float* restrict uvs, global const uint* restrict colours,
                              global const uint* restrict texels, uint triangle, const RasterVertex* v, int x,
                              int y) {
    if (draw->flags & DRAW_MASK) return 0;
    if (alwaysBlends(draw, material)) return 1;
    const float alpha = blendAlpha(draw, material, indices, uvs, colours, texels, triangle, v, x, y);
    return alpha > 0.0f && (material->transmission > 0.0f || alpha < BLEND_OPAQUE_ALPHA);
}

#endif
