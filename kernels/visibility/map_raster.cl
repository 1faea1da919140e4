// SPDX-License-Identifier: MIT
// Rasterises triangles into the depth maps of a light's views, keeping the nearest surface per texel.
//   vertices --light's frame--> (a, b, w) --two multiply-adds per view--> triangles --maximum--> depth maps
// Source: [VWSS] 2.1 (multi-view rasterisation), figure 6 (standard and conservative coverage); [MVSS]
// (bias applied when maps are written).
// Differs: a vertex is projected once for all views, since they are parallel and coplanar; `textbook` projects
// it anew for each. Both give the same maps bit for bit, as does map_raster_owned, where a map belongs to one
// work-item, needs no atomics, and takes small triangles LANES at a time.
#include "lib/atomics.h"
#include "lib/caster_opacity.h"
#include "lib/lanes.h"
#include "lib/opacity.h"
#include "shared/map_raster.h"
#include "shared/multi_view.h"

/// One work-item per vertex: vertices [3, vertexStride] become (a, b, w) of the central view, moved by kx, ky.
/// w = 0: nearer than the near clip, or not finite.
kernel void map_raster_vertices(const MultiViewParams light, const MapRasterParams params,
                                global const float* restrict positions, global float* restrict vertices) {
    const int vertex = get_global_id(0), stride = params.vertexStride;
    if (vertex >= params.vertexCount) return;
    const float3 p = load3(positions, (uint)vertex);
    const float x = dotPoint(light.lightFromWorld.row[0], p.x, p.y, p.z);
    const float y = dotPoint(light.lightFromWorld.row[1], p.x, p.y, p.z);
    const float z = dotPoint(light.lightFromWorld.row[2], p.x, p.y, p.z);
    const int inFront = z > light.nearClip && fabs(x) < 1e30f && fabs(y) < 1e30f && z < 1e30f;
    const float w = inFront ? light.near / z : 0.0f;
    const float a = inFront ? fma(light.focal, x / z, light.centre) : 0.0f;
    const float b = inFront ? fma(light.focal, y / z, light.centre) : 0.0f;
    vertices[vertex] = fma(-params.kx, w, a);
    vertices[stride + vertex] = fma(-params.ky, w, b);
    vertices[2 * stride + vertex] = w;
}

/// Corners of a triangle in the launch's view: divided already where all lie before the near clip, else
/// homogeneous, to be clipped. Depth is w / MAP_NEAR_CLIP, which is exact.
inline void mapVertices(const RasterView* view, const MapRasterParams* p, global const float* restrict vertices,
                        global const float* restrict positions, global const uint* restrict indices,
                        uint triangle, RasterVertex* v) {
    int clipped = 0;
    for (int i = 0; i < 3; ++i) {
        const uint vertex = indices[3 * triangle + i];
        const float w = vertices[2 * p->vertexStride + vertex];
        v[i].x = fma(-p->shiftX, w, vertices[vertex]);
        v[i].y = fma(-p->shiftY, w, vertices[p->vertexStride + vertex]);
        v[i].w = 1.0f;
        v[i].d = w * (1.0f / MAP_NEAR_CLIP);
        clipped |= !(w > 0.0f);
    }
    if (!clipped) return;
    for (int i = 0; i < 3; ++i) {
        v[i] = rasterVertex(view, positions, indices[3 * triangle + i]);
        v[i].x = fma(-p->kx * MAP_NEAR_CLIP, v[i].d, v[i].x);
        v[i].y = fma(-p->ky * MAP_NEAR_CLIP, v[i].d, v[i].y);
    }
}

/// 1 if a fragment blocks the view: alpha test and partial opacity.
inline int mapBlocks(const MultiViewParams* light, const Draw* draw, uint drawIndex, int view,
                     global const Material* materials, global const uint* indices,
                     global const float* restrict uvs, global const uint* restrict colours,
                     global const uint* restrict texels, uint triangle, const RasterVertex* v, int x, int y) {
    if (!(draw->flags & (DRAW_MASK | DRAW_BLEND))) return 1;
    RasterVertex homogeneous[3];  // depth is 1/z: what is divided already gets its distance back
    for (int i = 0; i < 3; ++i) {
        homogeneous[i].x = v[i].x / v[i].d;
        homogeneous[i].y = v[i].y / v[i].d;
        homogeneous[i].w = v[i].w / v[i].d;
    }
    const float opacity = casterOpacity(draw, materials, indices, uvs, colours, texels, triangle, homogeneous, x, y);
    if (!light->alphaKeys || !(opacity > 0.0f)) return opacity > 0.0f;
    return opacityBlocks(opacityKey(opacity, drawIndex), view, light->views, light->sampleStride);
}

inline float mapBias(const MapRasterParams* p, float depthX, float depthY) {
    return fma(p->biasSlope, max(fabs(depthX), fabs(depthY)), p->biasConstant);
}

inline uint mapBits(const MultiViewParams* light, float depth) {
    depth = clamp(depth, 0.0f, 1.0f);
    return light->depthBits == 32 ? as_uint(depth) : (uint)fma(depth, 65535.0f, 0.5f);
}

#define RASTER_KERNEL map_raster
#define RASTER_KERNEL_LARGE map_raster_large
#define RASTER_PARAMETERS                                                               \
    CASTER_ALPHA_PARAMETERS, const MultiViewParams light, const MapRasterParams params, \
        global const float *restrict vertices, volatile global uint *maps
#define RASTER_VERTICES mapVertices(&view, &params, vertices, positions, indices, triangle, v);
#define RASTER_BEGIN \
    volatile global uint* map = maps + (size_t)(params.view - params.firstView) * light.mapStride;
#define RASTER_TRIANGLE \
    const float bias = mapBias(&params, t.depthX * MAP_NEAR_CLIP, t.depthY * MAP_NEAR_CLIP);
#define RASTER_FRAGMENT                                                                                  \
    if (mapBlocks(&light, &draw, drawIndex, params.view, materials, indices, uvs, colours, texels,       \
                  triangle, v, x, y)) {                                                                  \
        const uint bits = mapBits(&light, depth * MAP_NEAR_CLIP - bias);                                 \
        volatile global uint* texel = &map[y * light.resolution + x];                                    \
        ATOMIC_MAX_EARLY(texel, bits)                                                                    \
    }
#define RASTER_END
#include "lib/raster.inl"

/// What all views need to know of a triangle: 0: none shows it, 1: small and opaque, 2: to be taken alone.
inline int mapTriangleKind(const MultiViewParams* light, const RasterView* view, const Draw* draw,
                           const float* a, const float* b, const float* w, uint* dropped) {
    *dropped = 0;
    if ((draw->flags & view->requireFlags) != view->requireFlags) return 0;
    if (!(w[0] > 0.0f && w[1] > 0.0f && w[2] > 0.0f)) return 2;
    const float reachX = light->halfWidth * light->focal / light->near;
    const float reachY = light->halfHeight * light->focal / light->near;
    const float lowW = min(w[0], min(w[1], w[2])), highW = max(w[0], max(w[1], w[2]));
    const float lowA = min(a[0], min(a[1], a[2])), highA = max(a[0], max(a[1], a[2]));
    const float lowB = min(b[0], min(b[1], b[2])), highB = max(b[0], max(b[1], b[2]));
    const float size = (float)light->resolution + 1.0f;
    if (highA + reachX * highW < -1.0f || lowA - reachX * highW > size || highB + reachY * highW < -1.0f ||
        lowB - reachY * highW > size)
        return 0;
    const uint mirrored = (draw->flags & DRAW_MIRRORED) != 0;
    if (draw->flags & (mirrored ? view->cullFront : view->cullBack)) *dropped |= MAP_DROP_CLOCKWISE;
    if (draw->flags & (mirrored ? view->cullBack : view->cullFront)) *dropped |= MAP_DROP_COUNTERCLOCKWISE;
    // The signed area is linear in the sample's offset: its range over the light decides for all views
    const float a1 = a[1] - a[0], a2 = a[2] - a[0], b1 = b[1] - b[0], b2 = b[2] - b[0];
    const float w1 = w[1] - w[0], w2 = w[2] - w[0];
    const float area = a1 * b2 - a2 * b1;
    const float range = fabs(w1 * b2 - w2 * b1) * reachX + fabs(a1 * w2 - a2 * w1) * reachY;
    const float spanX = highA - lowA + reachX * (highW - lowW), spanY = highB - lowB + reachY * (highW - lowW);
    const float snapping = (spanX + spanY) * (4.0f / 256.0f) + 1e-4f;
    if (*dropped & MAP_DROP_CLOCKWISE && area - range > snapping) return 0;
    if (*dropped & MAP_DROP_COUNTERCLOCKWISE && area + range < -snapping) return 0;
    if (draw->flags & (DRAW_MASK | DRAW_BLEND)) return 2;
    return max(spanX, spanY) < (float)(RASTER_SMALL - 1) ? 1 : 2;
}

#define MAP_SHARE_CHUNK 64

/// One work-item per MAP_SHARE_CHUNK triangles: lists what some view may show.
/// triangles [MAP_TRIANGLE_PLANES, capacity], flags [capacity] of the plain ones; specials [triangle]
kernel void map_raster_share(const MultiViewParams light, const RasterView view, const MapRasterParams params,
                             global const float* restrict vertices, global const uint* restrict indices,
                             global const uint* restrict triangleDraw, global const Draw* restrict draws,
                             global float* restrict triangles, global uint* restrict flags,
                             global uint* restrict specials, volatile global MapRasterCounts* counts) {
    const uint begin = (uint)get_global_id(0) * MAP_SHARE_CHUNK;
    const uint end = min(begin + MAP_SHARE_CHUNK, (uint)view.triangleCount);
    float kept[MAP_SHARE_CHUNK][MAP_TRIANGLE_PLANES];
    uint keptFlags[MAP_SHARE_CHUNK], keptSpecials[MAP_SHARE_CHUNK], plain = 0, special = 0;
    for (uint triangle = begin; triangle < end; ++triangle) {
        const Draw draw = draws[triangleDraw[triangle]];
        float a[3], b[3], w[3];
        for (int i = 0; i < 3; ++i) {
            const uint vertex = indices[3 * triangle + i];
            a[i] = vertices[vertex];
            b[i] = vertices[params.vertexStride + vertex];
            w[i] = vertices[2 * params.vertexStride + vertex];
        }
        uint dropped;
        const int kind = mapTriangleKind(&light, &view, &draw, a, b, w, &dropped);
        if (kind == 2) keptSpecials[special++] = triangle;
        if (kind != 1) continue;
        for (int i = 0; i < 3; ++i) {
            kept[plain][3 * i] = a[i];
            kept[plain][3 * i + 1] = b[i];
            kept[plain][3 * i + 2] = w[i];
        }
        keptFlags[plain++] = dropped;
    }
    if (plain) {
        const uint slot = atomic_add(&counts->plain, plain);
        for (uint i = 0; i < plain; ++i) {
            for (int plane = 0; plane < MAP_TRIANGLE_PLANES; ++plane)
                triangles[(size_t)plane * params.capacity + slot + i] = kept[i][plane];
            flags[slot + i] = keptFlags[i];
        }
    }
    if (special) {
        const uint slot = atomic_add(&counts->special, special);
        for (uint i = 0; i < special; ++i) specials[slot + i] = keptSpecials[i];
    }
}

// The owned forms differ in the map's texel type alone
#include "visibility/map_raster_lanes.h"
#define OWNED_TEXEL uint
#define OWNED(name) name##32
#define OWNED_KERNEL map_raster_owned
#include "visibility/map_raster_owned.inl"
#define OWNED_TEXEL ushort
#define OWNED(name) name##16
#define OWNED_KERNEL map_raster_owned16
#include "visibility/map_raster_owned.inl"
