// SPDX-License-Identifier: MIT
// Turns the nearest triangle of each pixel into surface attributes.
//   triangle per pixel --perspective-correct barycentrics--> position, normals, material
#include "lib/raster.h"
#include "lib/texture.h"
#include "shared/gbuffer.h"

typedef struct {
    float4 albedo;
    float3 emissive, normal;
    float metallic, roughness;
} Surface;

inline float3 interpolate3(global const float* values, uint v0, uint v1, uint v2, float3 b) {
    return load3(values, v0) * b.x + load3(values, v1) * b.y + load3(values, v2) * b.z;
}

/// Tangent of a triangle from its uv gradient, for meshes that bring none. Its bitangent points up in the
/// image, against v: glTF 2.0, 3.9.3.
inline float3 triangleTangent(float3 p0, float3 p1, float3 p2, float4 uv0, float4 uv1, float4 uv2,
                              const Texture* t, float3 normal, float* handedness) {
    const float2 a = textureTransform(t, uv0);
    const float2 d1 = textureTransform(t, uv1) - a, d2 = textureTransform(t, uv2) - a;
    const float determinant = d1.x * d2.y - d2.x * d1.y;
    // dP/du and -dP/dv, both times the determinant
    const float3 along = (p1 - p0) * d2.y - (p2 - p0) * d1.y;
    const float3 up = (p1 - p0) * d2.x - (p2 - p0) * d1.x;
    *handedness = dot(cross3(normal, along), up) < 0.0f ? -1.0f : 1.0f;
    return normalizeOr(determinant < 0.0f ? -along : along, (float3)(1.0f, 0.0f, 0.0f));
}

inline float3 applyNormalMap(float3 normal, float3 tangent, float handedness, float4 texel, float scale) {
    const float3 n = (float3)((texel.x * 2.0f - 1.0f) * scale, (texel.y * 2.0f - 1.0f) * scale,
                              texel.z * 2.0f - 1.0f);
    const float3 t = normalizeOr(tangent - normal * dot(normal, tangent), (float3)(1.0f, 0.0f, 0.0f));
    const float3 b = cross3(normal, t) * handedness;
    return normalizeOr(t * n.x + b * n.y + normal * n.z, normal);
}

inline void storePlane3(global float* planes, int stride, int plane, int pixel, float3 value) {
    planes[plane * stride + pixel] = value.x;
    planes[(plane + 1) * stride + pixel] = value.y;
    planes[(plane + 2) * stride + pixel] = value.z;
}

inline void storeBackground(global float* planes, int stride, int pixel) {
    for (int plane = 0; plane < GB_PLANES; ++plane) planes[plane * stride + pixel] = 0.0f;
    planes[GB_DEPTH * stride + pixel] = INFINITY;
}

/// One work-item per pixel of the padded image; the padding becomes background.
/// visibility         ~triangle per pixel, every idStride words; 0: background
/// previousPositions  posed vertices of the last frame
/// planes             see shared/gbuffer.h
kernel void gbuffer_resolve(const GBufferParams params, const RasterView view,
                            global const float* restrict positions,
                            global const float* restrict normals, global const float* restrict tangents,
                            global const float* restrict previousPositions,
                            global const uint* restrict indices,
                            global const uint* restrict triangleDraw, global const Draw* restrict draws,
                            global const Material* restrict materials, global const float* restrict uvs,
                            global const uint* restrict colours, global const uint* restrict texels,
                            global const uint* restrict visibility, global float* restrict planes) {
    const int pixel = get_global_id(0), stride = params.planeStride;
    if (pixel >= stride) return;
    const uint id = pixel < params.width * params.height ? visibility[pixel * params.idStride] : 0;
    if (id == 0) {
        storeBackground(planes, stride, pixel);
        return;
    }
    const int x = pixel % params.width, y = pixel / params.width;
    const uint triangle = ~id;
    const Draw draw = draws[triangleDraw[triangle]];
    const uint i0 = indices[3 * triangle], i1 = indices[3 * triangle + 1], i2 = indices[3 * triangle + 2];
    const RasterVertex v[3] = {rasterVertex(&view, positions, i0), rasterVertex(&view, positions, i1),
                               rasterVertex(&view, positions, i2)};
    const float3 b = rasterBarycentrics(v, x, y);

    // Geometry
    const float3 p0 = load3(positions, i0), p1 = load3(positions, i1), p2 = load3(positions, i2);
    const float3 position = p0 * b.x + p1 * b.y + p2 * b.z;
    const float3 towardsEye = params.eye.xyz - position * params.eye.w;
    float3 geometric = normalizeOr(cross3(p1 - p0, p2 - p0), (float3)(0.0f, 1.0f, 0.0f));
    if (dot(geometric, towardsEye) < 0.0f) geometric = -geometric;
    float3 normal = normalizeOr(interpolate3(normals, i0, i1, i2, b), geometric);
    const int back = dot(normal, geometric) < 0.0f;  // seen from behind: reversed, bumps included

    // Material
    global const Material* m = &materials[draw.material];
    const int s0 = (int)i0 + draw.sourceOffset, s1 = (int)i1 + draw.sourceOffset,
              s2 = (int)i2 + draw.sourceOffset;
    float4 albedo = m->baseColor;
    float3 emissive = m->emissive.xyz;
    float metallic = m->metallic, roughness = m->roughness;
    if (draw.flags & DRAW_COLOURS)
        albedo *= unpackColour(colours[s0]) * b.x + unpackColour(colours[s1]) * b.y +
                  unpackColour(colours[s2]) * b.z;
    if (draw.flags & DRAW_TEXTURED) {
        const float4 uv = readUvs(uvs, s0, s1, s2, b);
        // Neighbours on the plane: clamped into a small triangle they would tell too small a footprint
        const float4 right = readUvs(uvs, s0, s1, s2, rasterPlaneBarycentrics(v, x + 1, y));
        const float4 below = readUvs(uvs, s0, s1, s2, rasterPlaneBarycentrics(v, x, y + 1));
        const Texture colour = m->baseColorTexture, glow = m->emissiveTexture;
        const Texture rough = m->metallicRoughnessTexture, bumps = m->normalTexture;
        if (colour.offset >= 0)
            albedo *= textureRead(texels, &colour, uv, textureLevel(&colour, uv, right, below));
        if (glow.offset >= 0)
            emissive *= textureRead(texels, &glow, uv, textureLevel(&glow, uv, right, below)).xyz;
        if (rough.offset >= 0) {
            const float4 texel = textureRead(texels, &rough, uv, textureLevel(&rough, uv, right, below));
            roughness *= texel.y;
            metallic *= texel.z;
        }
        if (bumps.offset >= 0) {
            float3 tangent = (vload4(i0, tangents) * b.x + vload4(i1, tangents) * b.y +
                              vload4(i2, tangents) * b.z).xyz;
            float handedness = draw.flags & DRAW_MIRRORED ? -tangents[4 * i0 + 3] : tangents[4 * i0 + 3];
            if (handedness == 0.0f)
                tangent = triangleTangent(p0, p1, p2, vload4(s0, uvs), vload4(s1, uvs), vload4(s2, uvs),
                                          &bumps, normal, &handedness);
            normal = applyNormalMap(normal, tangent, handedness,
                                    textureRead(texels, &bumps, uv, textureLevel(&bumps, uv, right, below)),
                                    m->normalScale);
        }
    }
    if (back) normal = -normal;
    if (draw.flags & DRAW_UNLIT) {
        emissive = albedo.xyz;  // KHR_materials_unlit: nothing of the lit model counts
        albedo = (float4)(0.0f);
        metallic = 0.0f;
    }

    storePlane3(planes, stride, GB_POSITION, pixel, position);
    storePlane3(planes, stride, GB_GEOMETRIC, pixel, geometric);
    storePlane3(planes, stride, GB_NORMAL, pixel, normal);
    storePlane3(planes, stride, GB_ALBEDO, pixel, albedo.xyz);
    storePlane3(planes, stride, GB_EMISSIVE, pixel, emissive);
    storePlane3(planes, stride, GB_PREVIOUS, pixel,
                params.hasPrevious ? interpolate3(previousPositions, i0, i1, i2, b) : position);
    planes[GB_METALLIC * stride + pixel] = clamp(metallic, 0.0f, 1.0f);
    planes[GB_ROUGHNESS * stride + pixel] = clamp(roughness, 0.0f, 1.0f);
    planes[GB_DEPTH * stride + pixel] = dotPoint(params.rowDepth, position.x, position.y, position.z);
    planes[GB_OBJECT * stride + pixel] = as_float(draw.object);
    planes[GB_FLAGS * stride + pixel] = as_float(draw.flags);
}
