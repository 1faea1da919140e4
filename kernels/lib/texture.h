// SPDX-License-Identifier: MIT
// Bilinear texture reads from buffers of RGBA8 texels; MIP level chosen by the uv footprint.
#ifndef LIB_TEXTURE_H
#define LIB_TEXTURE_H
#include "shared/mesh.h"

inline int textureWrap(int i, int size, int mode) {
    if (mode == 1) return clamp(i, 0, size - 1);
    if (mode == 0) {
        const int r = i % size;
        return r < 0 ? r + size : r;
    }
    int r = i % (2 * size);
    if (r < 0) r += 2 * size;
    return r < size ? r : 2 * size - 1 - r;
}

inline float4 textureTexel(global const uint* restrict texels, const Texture* t, int base, int width,
                           int height, int x, int y) {
    x = textureWrap(x, width, t->wrap & 3);
    y = textureWrap(y, height, (t->wrap >> 2) & 3);
    const uint rgba = texels[base + y * width + x];
    const uint r = rgba & 255, g = (rgba >> 8) & 255, b = (rgba >> 16) & 255, a = rgba >> 24;
    const float byte = 1.0f / 255.0f;
    if (t->wrap & 32)
        return (float4)(as_float(texels[r]), as_float(texels[g]), as_float(texels[b]), (float)a * byte);
    return (float4)((float)r, (float)g, (float)b, (float)a) * byte;
}

inline float2 textureTransform(const Texture* t, float4 uvs) {
    const float2 uv = t->uvSet ? uvs.zw : uvs.xy;
    return (float2)(fma(t->a, uv.x, fma(t->b, uv.y, t->c)), fma(t->d, uv.x, fma(t->e, uv.y, t->f)));
}

/// Reads a texture at uv sets `uvs` = (u0, v0, u1, v1) at a MIP level.
inline float4 textureRead(global const uint* restrict texels, const Texture* t, float4 uvs, int level) {
    const float2 uv = textureTransform(t, uvs);
    level = clamp(level, 0, t->levels - 1);
    int base = t->offset, width = t->width, height = t->height;
    for (int i = 0; i < level; ++i) {
        base += width * height;
        width = max(width >> 1, 1);
        height = max(height >> 1, 1);
    }
    // Coordinates far out lose their fraction anyway; keep the conversion defined
    const float u = clamp(uv.x, -1e5f, 1e5f) * (float)width, v = clamp(uv.y, -1e5f, 1e5f) * (float)height;
    if (t->wrap & 16)
        return textureTexel(texels, t, base, width, height, (int)floor(u), (int)floor(v));
    const float fx = floor(u - 0.5f), fy = floor(v - 0.5f);
    const int x = (int)fx, y = (int)fy;
    const float wx = u - 0.5f - fx, wy = v - 0.5f - fy;
    const float4 top = mix(textureTexel(texels, t, base, width, height, x, y),
                           textureTexel(texels, t, base, width, height, x + 1, y), wx);
    const float4 bottom = mix(textureTexel(texels, t, base, width, height, x, y + 1),
                              textureTexel(texels, t, base, width, height, x + 1, y + 1), wx);
    return mix(top, bottom, wy);
}

/// MIP level at which a pixel's footprint is about a texel: floor(log2) of the longer of the two uv
/// steps, read off the exponent.
inline int textureLevel(const Texture* t, float4 uvs, float4 uvsRight, float4 uvsBelow) {
    const float2 uv = textureTransform(t, uvs);
    const float2 size = (float2)((float)t->width, (float)t->height);
    const float2 dx = (textureTransform(t, uvsRight) - uv) * size;
    const float2 dy = (textureTransform(t, uvsBelow) - uv) * size;
    const float squared = max(dx.x * dx.x + dx.y * dx.y, dy.x * dy.x + dy.y * dy.y);
    return max((int)(as_uint(squared) >> 23) - 127, 0) / 2;
}

inline float4 readUvs(global const float* restrict uvs, int v0, int v1, int v2, float3 b) {
    return vload4(v0, uvs) * b.x + vload4(v1, uvs) * b.y + vload4(v2, uvs) * b.z;
}

inline float4 unpackColour(uint rgba) {
    return (float4)((float)(rgba & 255), (float)((rgba >> 8) & 255), (float)((rgba >> 16) & 255),
                    (float)(rgba >> 24)) * (1.0f / 255.0f);
}

/// Alpha of a surface point at texture level 0: factor x texture x vertex colour; 1 where it is ignored.
inline float surfaceAlpha(const Draw* draw, global const Material* material, global const uint* indices,
                          global const float* restrict uvs, global const uint* restrict colours,
                          global const uint* restrict texels, uint triangle, float3 b) {
    if (material->flags & MATERIAL_OPAQUE) return 1.0f;
    const int v0 = (int)indices[3 * triangle] + draw->sourceOffset;
    const int v1 = (int)indices[3 * triangle + 1] + draw->sourceOffset;
    const int v2 = (int)indices[3 * triangle + 2] + draw->sourceOffset;
    float alpha = material->baseColor.w;
    const Texture t = material->baseColorTexture;
    if (t.offset >= 0) alpha *= textureRead(texels, &t, readUvs(uvs, v0, v1, v2, b), 0).w;
    if (draw->flags & DRAW_COLOURS)
        alpha *= ((float)(colours[v0] >> 24) * b.x + (float)(colours[v1] >> 24) * b.y +
                  (float)(colours[v2] >> 24) * b.z) * (1.0f / 255.0f);
    return alpha;
}

#endif
