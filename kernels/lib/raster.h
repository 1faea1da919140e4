// SPDX-License-Identifier: MIT
// Triangle set-up, coverage and depth; used through lib/raster.inl.
// Coverage is exact: vertices are snapped to 1/256 pixel, edge functions are integers, edges shared by
// two triangles belong to one of them (top-left rule), so a closed mesh has no gaps and no overlaps.
#ifndef LIB_RASTER_H
#define LIB_RASTER_H
#include "lib/transform.h"
#include "shared/mesh.h"
#include "shared/raster.h"

/// A vertex in homogeneous pixel coordinates: pixel = (x, y) / w, depth = d / w.
typedef struct {
    float x, y, w, d;
} RasterVertex;

/// An edge as a pixel (column, row) sees it: inside if c + a * column + b * row >= 0.
typedef struct {
    int a, b;
    long c;  ///< at pixel (0, 0); carries the top-left rule
} RasterEdge;

typedef struct {
    RasterEdge edge[3];
    int minX, minY, maxX, maxY;           ///< pixels whose centres may be covered; empty if min > max
    int small;                            ///< extent of at most RASTER_SMALL pixels
    float depth0, depthX, depthY, x0, y0; ///< plane of depth through vertex 0
    float depthMin, depthMax;
} RasterTriangle;

inline RasterVertex rasterVertex(const RasterView* view, global const float* positions, uint vertex) {
    const float x = positions[3 * vertex], y = positions[3 * vertex + 1], z = positions[3 * vertex + 2];
    RasterVertex v;
    v.x = dotPoint(view->rowX, x, y, z);
    v.y = dotPoint(view->rowY, x, y, z);
    v.w = dotPoint(view->rowW, x, y, z);
    v.d = dotPoint(view->rowD, x, y, z);
    return v;
}

#define RASTER_GUARD 32768.0f  // pixels: vertices beyond are clipped, so that snapped ones fit 24 bits

/// Signed distance to clip plane 0..4, >= 0 inside: near, left, right, top, bottom of the guard band.
inline float rasterClipDistance(RasterVertex v, int plane) {
    switch (plane) {
        case 0: return v.w - v.d;
        case 1: return fma(RASTER_GUARD, v.w, v.x);
        case 2: return fma(RASTER_GUARD, v.w, -v.x);
        case 3: return fma(RASTER_GUARD, v.w, v.y);
        default: return fma(RASTER_GUARD, v.w, -v.y);
    }
}

#define RASTER_REJECT 0
#define RASTER_WHOLE 1
#define RASTER_CLIP 2

/// Whether a triangle is off the screen, needs no clipping, or needs it. Non-finite ones are off.
inline int rasterClassify(const RasterView* view, const RasterVertex* v) {
    int outside = 31, clip = 0, sane = 1;
    for (int i = 0; i < 3; ++i) {
        const float right = (float)view->width * v[i].w, bottom = (float)view->height * v[i].w;
        outside &= (v[i].x < 0.0f) | (v[i].x > right) << 1 | (v[i].y < 0.0f) << 2 |
                   (v[i].y > bottom) << 3 | (v[i].d > v[i].w) << 4;
        for (int plane = 0; plane < 5; ++plane) clip |= !(rasterClipDistance(v[i], plane) >= 0.0f);
        sane &= fabs(v[i].x) < 1e30f && fabs(v[i].y) < 1e30f && fabs(v[i].w) < 1e30f;
    }
    if (!sane || outside) return RASTER_REJECT;
    return clip ? RASTER_CLIP : RASTER_WHOLE;
}

#define RASTER_MAX_CORNERS 9

/// Clips a triangle to the near plane and the guard band; returns the corners of the convex rest.
/// Cuts run from the inner to the outer vertex, so that two triangles cut a shared edge alike.
inline int rasterClip(RasterVertex* corners) {
    int count = 3;
    for (int plane = 0; plane < 5 && count > 0; ++plane) {
        RasterVertex out[RASTER_MAX_CORNERS];
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const RasterVertex p = corners[i], q = corners[i + 1 == count ? 0 : i + 1];
            const float dp = rasterClipDistance(p, plane), dq = rasterClipDistance(q, plane);
            // At most one corner more per plane; rounding on slivers must not go past the array
            if (kept + 2 > RASTER_MAX_CORNERS) break;
            if (dp >= 0.0f) out[kept++] = p;
            if ((dp >= 0.0f) == (dq >= 0.0f)) continue;
            const RasterVertex in = dp >= 0.0f ? p : q, off = dp >= 0.0f ? q : p;
            const float t = (dp >= 0.0f ? dp : dq) / (dp >= 0.0f ? dp - dq : dq - dp);
            out[kept].x = fma(t, off.x - in.x, in.x);
            out[kept].y = fma(t, off.y - in.y, in.y);
            out[kept].w = fma(t, off.w - in.w, in.w);
            out[kept].d = plane == 0 ? out[kept].w : fma(t, off.d - in.d, in.d);
            ++kept;
        }
        count = kept;
        for (int i = 0; i < count; ++i) corners[i] = out[i];
    }
    return count < 3 ? 0 : count;
}

/// conservative: the edge is moved outwards by half a pixel, so that every pixel it crosses is inside.
inline RasterEdge rasterEdge(int xa, int ya, int xb, int yb, int conservative) {
    const int dx = xb - xa, dy = yb - ya;
    RasterEdge e;
    e.a = -dy;
    e.b = dx;
    // Value at the centre of pixel (0, 0); only edges at the top and left own their points
    const int midpoint = 1 << (RASTER_SUBPIXEL_BITS - 1);
    const long value = (long)dx * (midpoint - ya) - (long)dy * (midpoint - xa);
    const int owns = conservative || dy < 0 || (dy == 0 && dx > 0);
    const long widened = conservative ? ((long)abs(dx) + abs(dy)) * midpoint : 0;
    e.c = (value + widened - (owns ? 0 : 1)) >> RASTER_SUBPIXEL_BITS;
    return e;
}

/// To the nearest sub-pixel; rint is an instruction where convert_int_rte is a dozen.
inline int rasterSnap(float value) {
    return convert_int(rint(value));
}

/// Sets up a clipped triangle; returns 0 if it is culled or covers nothing.
inline int rasterSetup(const RasterView* view, uint flags, RasterVertex v0, RasterVertex v1,
                       RasterVertex v2, RasterTriangle* t) {
    const float scale = (float)(1 << RASTER_SUBPIXEL_BITS);
    const float r0 = 1.0f / v0.w, r1 = 1.0f / v1.w, r2 = 1.0f / v2.w;
    int x0 = rasterSnap(v0.x * r0 * scale), y0 = rasterSnap(v0.y * r0 * scale);
    int x1 = rasterSnap(v1.x * r1 * scale), y1 = rasterSnap(v1.y * r1 * scale);
    int x2 = rasterSnap(v2.x * r2 * scale), y2 = rasterSnap(v2.y * r2 * scale);
    float d0 = v0.d * r0, d1 = v1.d * r1, d2 = v2.d * r2;

    // Rows run downwards: a positive area turns clockwise on the screen
    const long area = (long)(x1 - x0) * (y2 - y0) - (long)(x2 - x0) * (y1 - y0);
    if (area == 0) return 0;
    const uint clockwise = (area > 0) ^ ((flags & DRAW_MIRRORED) != 0);
    const uint front = clockwise == view->frontIsClockwise;
    if (!(flags & view->keepBoth) && (flags & (front ? view->cullFront : view->cullBack))) return 0;
    if (area < 0) {
        int swap = x1; x1 = x2; x2 = swap;
        swap = y1; y1 = y2; y2 = swap;
        const float depth = d1; d1 = d2; d2 = depth;
    }

    const int left = min(x0, min(x1, x2)), right = max(x0, max(x1, x2));
    const int top = min(y0, min(y1, y2)), bottom = max(y0, max(y1, y2));
    // First and last pixel: by their centres, or by their whole squares
    const int midpoint = view->conservative ? 0 : 1 << (RASTER_SUBPIXEL_BITS - 1);
    const int below = view->conservative ? 0 : midpoint - 1;
    t->minX = max((left + below) >> RASTER_SUBPIXEL_BITS, 0);
    t->minY = max((top + below) >> RASTER_SUBPIXEL_BITS, 0);
    t->maxX = min((right - midpoint) >> RASTER_SUBPIXEL_BITS, view->width - 1);
    t->maxY = min((bottom - midpoint) >> RASTER_SUBPIXEL_BITS, view->height - 1);
    if (t->minX > t->maxX || t->minY > t->maxY) return 0;
    t->small = max(right - left, bottom - top) <= (RASTER_SMALL << RASTER_SUBPIXEL_BITS);

    t->edge[0] = rasterEdge(x0, y0, x1, y1, view->conservative);
    t->edge[1] = rasterEdge(x1, y1, x2, y2, view->conservative);
    t->edge[2] = rasterEdge(x2, y2, x0, y0, view->conservative);

    const float inverse = scale * scale / (float)(area < 0 ? -area : area);
    const float ax = (float)(x1 - x0) / scale, ay = (float)(y1 - y0) / scale;
    const float bx = (float)(x2 - x0) / scale, by = (float)(y2 - y0) / scale;
    t->depth0 = d0;
    t->depthX = ((d1 - d0) * by - (d2 - d0) * ay) * inverse;
    t->depthY = ((d2 - d0) * ax - (d1 - d0) * bx) * inverse;
    t->x0 = (float)x0 / scale - 0.5f;
    t->y0 = (float)y0 / scale - 0.5f;
    // Never below 0: the bits of depths must order like the depths
    t->depthMin = max(min(d0, min(d1, d2)), 0.0f);
    t->depthMax = max(max(d0, max(d1, d2)), 0.0f);
    return 1;
}

/// Depth at the centre of a pixel; never beyond the vertices' depths.
inline float rasterDepth(const RasterTriangle* t, int x, int y) {
    const float depth = fma(t->depthX, (float)x - t->x0, fma(t->depthY, (float)y - t->y0, t->depth0));
    return clamp(depth, t->depthMin, t->depthMax);
}

/// An edge's value at pixel (x, y), within what 32 bits hold over a tile: farther ones decide a
/// tile as a whole, and their sign is all that counts.
inline int rasterEdgeAt(RasterEdge e, int x, int y) {
    const long value = e.c + (long)e.a * x + (long)e.b * y;
    return (int)clamp(value, (long)-(1 << 30), (long)(1 << 30));
}

/// The edges' values at a tile's first pixel; 1 if one edge leaves out the tile as a whole.
inline int rasterTileOutside(const RasterTriangle* t, int left, int top, int* base) {
    int outside = 0;
    for (int i = 0; i < 3; ++i) {
        base[i] = rasterEdgeAt(t->edge[i], left, top);
        const int reach = max(t->edge[i].a, 0) + max(t->edge[i].b, 0);
        outside |= base[i] + (RASTER_TILE - 1) * reach < 0;
    }
    return outside;
}

/// Perspective-correct barycentric coordinates at a pixel's centre, up to a factor.
inline float3 rasterWeights(const RasterVertex* v, int x, int y) {
    const float px = (float)x + 0.5f, py = (float)y + 0.5f;
    float sx[3], sy[3];
    for (int i = 0; i < 3; ++i) {
        sx[i] = fma(-px, v[i].w, v[i].x);
        sy[i] = fma(-py, v[i].w, v[i].y);
    }
    return (float3)(sx[1] * sy[2] - sx[2] * sy[1], sx[2] * sy[0] - sx[0] * sy[2],
                    sx[0] * sy[1] - sx[1] * sy[0]);
}

/// Perspective-correct barycentric coordinates at a pixel's centre, from vertices before clipping.
/// Snapping may have put the centre slightly outside: clamped into the triangle.
inline float3 rasterBarycentrics(const RasterVertex* v, int x, int y) {
    float3 b = rasterWeights(v, x, y);
    if (b.x + b.y + b.z < 0.0f) b = -b;
    b = max(b, (float3)(0.0f));
    const float sum = b.x + b.y + b.z;
    return sum > 0.0f ? b / sum : (float3)(1.0f, 0.0f, 0.0f);
}

/// The same on the triangle's plane, also outside of the triangle; not finite where a pixel sees the plane
/// edge-on.
inline float3 rasterPlaneBarycentrics(const RasterVertex* v, int x, int y) {
    const float3 b = rasterWeights(v, x, y);
    return b / (b.x + b.y + b.z);
}

#endif
