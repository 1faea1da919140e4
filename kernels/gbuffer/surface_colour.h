// SPDX-License-Identifier: MIT
// Base colour and alpha of a triangle at a pixel, textures filtered by the pixel's footprint.
#ifndef GBUFFER_SURFACE_COLOUR_H
#define GBUFFER_SURFACE_COLOUR_H
#include "lib/raster.h"
#include "lib/texture.h"

typedef struct {
    float3 b;                 ///< perspective-correct barycentric coordinates
    int s0, s1, s2;           ///< source vertices: uvs and colours are kept once per primitive
    float4 uv, right, below;  ///< at the pixel and at its neighbours; only of textured draws
} SurfacePoint;

inline SurfacePoint surfacePoint(const Draw* draw, global const uint* indices, global const float* restrict uvs,
                                 uint triangle, const RasterVertex* v, int x, int y) {
    SurfacePoint p;
    p.b = rasterBarycentrics(v, x, y);
    p.s0 = (int)indices[3 * triangle] + draw->sourceOffset;
    p.s1 = (int)indices[3 * triangle + 1] + draw->sourceOffset;
    p.s2 = (int)indices[3 * triangle + 2] + draw->sourceOffset;
    p.uv = p.right = p.below = (float4)(0.0f);
    if (draw->flags & DRAW_TEXTURED) {
        p.uv = readUvs(uvs, p.s0, p.s1, p.s2, p.b);
        // Neighbours on the plane: clamped into a small triangle they would tell too small a footprint
        p.right = readUvs(uvs, p.s0, p.s1, p.s2, rasterPlaneBarycentrics(v, x + 1, y));
        p.below = readUvs(uvs, p.s0, p.s1, p.s2, rasterPlaneBarycentrics(v, x, y + 1));
    }
    return p;
}

inline float4 surfaceTexel(const SurfacePoint* p, const Texture* t, global const uint* restrict texels) {
    return textureRead(texels, t, p->uv, textureLevel(t, p->uv, p->right, p->below));
}

/// Factor x vertex colour x texture.
inline float4 surfaceColour(const Draw* draw, global const Material* m, const SurfacePoint* p,
                            global const uint* restrict colours, global const uint* restrict texels) {
    float4 colour = m->baseColor;
    if (draw->flags & DRAW_COLOURS)
        colour *= unpackColour(colours[p->s0]) * p->b.x + unpackColour(colours[p->s1]) * p->b.y +
                  unpackColour(colours[p->s2]) * p->b.z;
    const Texture t = m->baseColorTexture;
    if (t.offset >= 0) colour *= surfaceTexel(p, &t, texels);
    return colour;
}

#endif
