// SPDX-License-Identifier: MIT
// Turns the nearest triangle of each pixel, and those of the blended fragments before it, into surface
// attributes.
//   triangle per pixel or fragment --perspective-correct barycentrics--> position, normals, material
#include "gbuffer/surface_colour.h"
#include "shared/abuffer.h"
#include "shared/gbuffer.h"

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

/// What a pixel of the G-buffer shows, and where the camera sees it.
typedef struct {
    uint id;       ///< ~triangle; 0: background
    int x, y;
    int fragment;  ///< of the A-buffer; -1: a pixel of the image
} PixelSource;

inline PixelSource pixelSource(const GBufferParams* params, int pixel, global const uint* restrict visibility,
                               global const uint* restrict ends, global const uint* restrict fragments,
                               global const uint* restrict owners) {
    const int pixels = params->width * params->height;
    PixelSource s = {0, 0, 0, -1};
    int at = pixel;
    if (pixel < pixels) {
        s.id = visibility[pixel * params->idStride];
    } else if (params->fragmentCapacity > 0) {
        s.fragment = pixel - pixels;
        if ((uint)s.fragment >= min(ends[pixels - 1], params->fragmentCapacity)) return s;
        s.id = ~fragments[2 * s.fragment + 1];
        at = (int)owners[s.fragment];
    }
    s.x = at % params->width;
    s.y = at / params->width;
    return s;
}

/// A blended fragment: what is behind it shines through by alpha and transmission. What is transmitted is not
/// reflected: KHR_materials_transmission.
inline void blendSurface(global const Material* m, uint capacity, int fragment, float4* albedo,
                         global float* restrict coverage) {
    const float alpha = m->flags & MATERIAL_OPAQUE ? 1.0f : clamp(albedo->w, 0.0f, 1.0f);
    const float3 filter = albedo->xyz * (alpha * m->transmission);
    coverage[COVERAGE_ALPHA * capacity + fragment] = alpha;
    coverage[COVERAGE_THROUGH * capacity + fragment] = 1.0f - alpha + filter.x;
    coverage[(COVERAGE_THROUGH + 1) * capacity + fragment] = 1.0f - alpha + filter.y;
    coverage[(COVERAGE_THROUGH + 2) * capacity + fragment] = 1.0f - alpha + filter.z;
    *albedo *= 1.0f - m->transmission;
}

/// One work-item per pixel of the G-buffer; the padding becomes background.
/// visibility         ~triangle per pixel of the image, every idStride words; 0: background
/// previousPositions  posed vertices of the last frame
/// ends, fragments, owners, coverage  see shared/abuffer.h
/// planes             see shared/gbuffer.h
kernel void gbuffer_resolve(const GBufferParams params, const RasterView view,
                            global const float* restrict positions,
                            global const float* restrict normals, global const float* restrict tangents,
                            global const float* restrict previousPositions,
                            global const uint* restrict indices,
                            global const uint* restrict triangleDraw, global const Draw* restrict draws,
                            global const Material* restrict materials, global const float* restrict uvs,
                            global const uint* restrict colours, global const uint* restrict texels,
                            global const uint* restrict visibility, global const uint* restrict ends,
                            global const uint* restrict fragments, global const uint* restrict owners,
                            global float* restrict coverage, global float* restrict planes) {
    const int pixel = get_global_id(0), stride = params.planeStride;
    if (pixel >= stride) return;
    const PixelSource source = pixelSource(&params, pixel, visibility, ends, fragments, owners);
    if (source.id == 0) {
        storeBackground(planes, stride, pixel);
        return;
    }
    const int x = source.x, y = source.y;
    const uint triangle = ~source.id;
    const Draw draw = draws[triangleDraw[triangle]];
    const uint i0 = indices[3 * triangle], i1 = indices[3 * triangle + 1], i2 = indices[3 * triangle + 2];
    const RasterVertex v[3] = {rasterVertex(&view, positions, i0), rasterVertex(&view, positions, i1),
                               rasterVertex(&view, positions, i2)};
    const SurfacePoint point = surfacePoint(&draw, indices, uvs, triangle, v, x, y);
    const float3 b = point.b;

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
    float4 albedo = surfaceColour(&draw, m, &point, colours, texels);
    float3 emissive = m->emissive.xyz;
    float metallic = m->metallic, roughness = m->roughness;
    if (draw.flags & DRAW_TEXTURED) {
        const Texture glow = m->emissiveTexture, rough = m->metallicRoughnessTexture, bumps = m->normalTexture;
        if (glow.offset >= 0) emissive *= surfaceTexel(&point, &glow, texels).xyz;
        if (rough.offset >= 0) {
            const float4 texel = surfaceTexel(&point, &rough, texels);
            roughness *= texel.y;
            metallic *= texel.z;
        }
        if (bumps.offset >= 0) {
            float3 tangent = (vload4(i0, tangents) * b.x + vload4(i1, tangents) * b.y +
                              vload4(i2, tangents) * b.z).xyz;
            float handedness = draw.flags & DRAW_MIRRORED ? -tangents[4 * i0 + 3] : tangents[4 * i0 + 3];
            if (handedness == 0.0f)
                tangent = triangleTangent(p0, p1, p2, vload4(point.s0, uvs), vload4(point.s1, uvs),
                                          vload4(point.s2, uvs), &bumps, normal, &handedness);
            normal = applyNormalMap(normal, tangent, handedness, surfaceTexel(&point, &bumps, texels),
                                    m->normalScale);
        }
    }
    if (source.fragment >= 0) blendSurface(m, params.fragmentCapacity, source.fragment, &albedo, coverage);
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
