// SPDX-License-Identifier: MIT
// What a caster's fragment takes of the light, with textures read at the footprint of the light's texel.
#ifndef LIB_MLSM_OPACITY_H
#define LIB_MLSM_OPACITY_H
#include "lib/caster_opacity.h"

/// Base colour of a surface point at the MIP level of the texel's footprint, and that level. coverage: alpha of the
/// texture alone, which above level 0 of an alpha-tested material is the share that passes the test.
inline float4 footprintColour(const Draw* draw, global const Material* m, global const uint* indices,
                              global const float* restrict uvs, global const uint* restrict colours,
                              global const uint* restrict texels, uint triangle, const RasterVertex* v, int x, int y,
                              int* level, float* coverage) {
    const int v0 = (int)indices[3 * triangle] + draw->sourceOffset;
    const int v1 = (int)indices[3 * triangle + 1] + draw->sourceOffset;
    const int v2 = (int)indices[3 * triangle + 2] + draw->sourceOffset;
    const float3 b = rasterBarycentrics(v, x, y);
    float4 colour = m->baseColor;
    const Texture t = m->baseColorTexture;
    *level = 0;
    if (t.offset >= 0) {
        const float4 uv = readUvs(uvs, v0, v1, v2, b);
        const float4 right = readUvs(uvs, v0, v1, v2, rasterPlaneBarycentrics(v, x + 1, y));
        const float4 below = readUvs(uvs, v0, v1, v2, rasterPlaneBarycentrics(v, x, y + 1));
        *level = min(textureLevel(&t, uv, right, below), t.levels - 1);
        const float4 texel = textureRead(texels, &t, uv, *level);
        *coverage = texel.w;
        colour *= texel;
    }
    if (draw->flags & DRAW_COLOURS)
        colour *= unpackColour(colours[v0]) * b.x + unpackColour(colours[v1]) * b.y + unpackColour(colours[v2]) * b.z;
    return colour;
}

/// x, y, z: what is taken of red, green and blue; w: share of the texel that is covered; 0: no fragment.
/// Alpha-tested surfaces are covered or not where the texture is magnified, and by the share that passes the test where
/// it is minified ([MLSM] 5.3); blended ones cover whole texels and let T = (1 - a)(1 - a + a c) through,
/// transmissive ones T = 1 - a + a t c.
inline float4 mlsmOpacity(const Draw* draw, global const Material* materials, global const uint* indices,
                          global const float* restrict uvs, global const uint* restrict colours,
                          global const uint* restrict texels, uint triangle, const RasterVertex* v, int x, int y) {
    if (!(draw->flags & (DRAW_MASK | DRAW_BLEND))) return (float4)(1.0f);
    global const Material* m = &materials[draw->material];
    int level;
    float coverage = 1.0f;
    const float4 colour = footprintColour(draw, m, indices, uvs, colours, texels, triangle, v, x, y, &level, &coverage);
    const float alpha = m->flags & MATERIAL_OPAQUE ? 1.0f : clamp(colour.w, 0.0f, 1.0f);
    if (draw->flags & DRAW_MASK)
        return (float4)(level > 0 ? coverage : colour.w >= m->alphaCutoff ? 1.0f : 0.0f);
    const float4 tint = 1.0f - alpha + alpha * colour * (m->transmission > 0.0f ? m->transmission : 1.0f);
    const float4 taken = clamp(1.0f - (m->transmission > 0.0f ? tint : (1.0f - alpha) * tint), 0.0f, 1.0f);
    return (float4)(taken.xyz, max(max(taken.x, taken.y), taken.z) > 0.0f ? 1.0f : 0.0f);
}

#endif
