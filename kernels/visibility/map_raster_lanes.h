// SPDX-License-Identifier: MIT
// LANES small triangles at once: the arithmetic of lib/raster.h, bit for bit, in 32-bit integers, which
// hold it for extents up to RASTER_SMALL.
#ifndef MAP_RASTER_LANES_H
#define MAP_RASTER_LANES_H
#include "lib/lanes.h"
#include "lib/raster.h"
#include "shared/map_raster.h"
#include "shared/multi_view.h"

/// Corners in 1/256 texel, oriented clockwise on the screen, with depths.
typedef struct {
    VI x[3], y[3];
    VF depth[3];
    VI area;  ///< before orienting
    VI minX, minY, maxX, maxY;
} LaneTriangles;

/// Snaps corners of one view: u = a - kx w, v = b - ky w.
inline void laneSnap(LaneTriangles* t, const VF* a, const VF* b, const VF* w, float kx, float ky) {
    const float scale = (float)(1 << RASTER_SUBPIXEL_BITS);
    for (int i = 0; i < 3; ++i) {
        t->x[i] = V_TO_INT_RTE(fma((VF)-kx, w[i], a[i]) * scale);
        t->y[i] = V_TO_INT_RTE(fma((VF)-ky, w[i], b[i]) * scale);
        t->depth[i] = w[i];
    }
    t->area = (t->x[1] - t->x[0]) * (t->y[2] - t->y[0]) - (t->x[2] - t->x[0]) * (t->y[1] - t->y[0]);
}

inline void laneBox(LaneTriangles* t, int size, int conservative) {
    const int midpoint = conservative ? 0 : 1 << (RASTER_SUBPIXEL_BITS - 1), below = conservative ? 0 : midpoint - 1;
    const VI left = min(t->x[0], min(t->x[1], t->x[2])), right = max(t->x[0], max(t->x[1], t->x[2]));
    const VI top = min(t->y[0], min(t->y[1], t->y[2])), bottom = max(t->y[0], max(t->y[1], t->y[2]));
    t->minX = max((left + below) >> RASTER_SUBPIXEL_BITS, (VI)0);
    t->minY = max((top + below) >> RASTER_SUBPIXEL_BITS, (VI)0);
    t->maxX = min((right - midpoint) >> RASTER_SUBPIXEL_BITS, (VI)(size - 1));
    t->maxY = min((bottom - midpoint) >> RASTER_SUBPIXEL_BITS, (VI)(size - 1));
}

/// Lanes that are not culled, not degenerate, and may cover a texel.
inline VI laneLive(const LaneTriangles* t, VI flags) {
    const VI clockwise = V_MASK(t->area > 0), counterclockwise = V_MASK(t->area < 0);
    const VI dropped = (clockwise & V_MASK((flags & (int)MAP_DROP_CLOCKWISE) != 0)) |
                       (counterclockwise & V_MASK((flags & (int)MAP_DROP_COUNTERCLOCKWISE) != 0));
    return (clockwise | counterclockwise) & ~dropped & V_MASK(t->minX <= t->maxX) & V_MASK(t->minY <= t->maxY);
}

inline void laneOrient(LaneTriangles* t) {
    const VI turn = V_MASK(t->area < 0);
    const VI x = t->x[1], y = t->y[1];
    const VF depth = t->depth[1];
    t->x[1] = V_SELECT(x, t->x[2], turn);
    t->x[2] = V_SELECT(t->x[2], x, turn);
    t->y[1] = V_SELECT(y, t->y[2], turn);
    t->y[2] = V_SELECT(t->y[2], y, turn);
    t->depth[1] = V_SELECT(depth, t->depth[2], turn);
    t->depth[2] = V_SELECT(t->depth[2], depth, turn);
}

/// Edge i's value at texel (minX, minY); its steps per column and row are -dy and dx.
inline VI laneEdge(const LaneTriangles* t, int i, int conservative, VI* stepX, VI* stepY) {
    const int j = i == 2 ? 0 : i + 1, midpoint = 1 << (RASTER_SUBPIXEL_BITS - 1);
    const VI dx = t->x[j] - t->x[i], dy = t->y[j] - t->y[i];
    const VI owns = V_MASK(dy < 0) | (V_MASK(dy == 0) & V_MASK(dx > 0));
    const VI px = (t->minX << RASTER_SUBPIXEL_BITS) + midpoint - t->x[i];
    const VI py = (t->minY << RASTER_SUBPIXEL_BITS) + midpoint - t->y[i];
    VI value = dx * py - dy * px;
    if (conservative)
        value += (max(dx, -dx) + max(dy, -dy)) * midpoint;
    else
        value += ~owns;  // -1 where the edge does not own its points
    *stepX = -dy;
    *stepY = dx;
    return value >> RASTER_SUBPIXEL_BITS;
}

/// Plane of depth through corner 0, as rasterSetup has it.
typedef struct {
    VF depth0, depthX, depthY, x0, y0, low, high;
} LaneDepth;

inline LaneDepth laneDepth(const LaneTriangles* t) {
    const float scale = (float)(1 << RASTER_SUBPIXEL_BITS);
    const VF inverse = scale * scale / V_TO_FLOAT(max(t->area, -t->area));
    const VF ax = V_TO_FLOAT(t->x[1] - t->x[0]) / scale, ay = V_TO_FLOAT(t->y[1] - t->y[0]) / scale;
    const VF bx = V_TO_FLOAT(t->x[2] - t->x[0]) / scale, by = V_TO_FLOAT(t->y[2] - t->y[0]) / scale;
    const VF d1 = t->depth[1] - t->depth[0], d2 = t->depth[2] - t->depth[0];
    LaneDepth d;
    d.depth0 = t->depth[0];
    d.depthX = (d1 * by - d2 * ay) * inverse;
    d.depthY = (d2 * ax - d1 * bx) * inverse;
    d.x0 = V_TO_FLOAT(t->x[0]) / scale - 0.5f;
    d.y0 = V_TO_FLOAT(t->y[0]) / scale - 0.5f;
    d.low = max(min(t->depth[0], min(t->depth[1], t->depth[2])), (VF)0.0f);
    d.high = max(max(t->depth[0], max(t->depth[1], t->depth[2])), (VF)0.0f);
    return d;
}

inline VF laneDepthAt(const LaneDepth* d, VI x, VI y) {
    const VF depth = fma(d->depthX, V_TO_FLOAT(x) - d->x0, fma(d->depthY, V_TO_FLOAT(y) - d->y0, d->depth0));
    return clamp(depth, d->low, d->high);
}

inline VU laneBits(const MultiViewParams* light, VF depth) {
    depth = clamp(depth, (VF)0.0f, (VF)1.0f);
    return light->depthBits == 32 ? V_AS_UINT(depth) : V_AS_UINT(V_TO_INT(fma(depth, (VF)65535.0f, (VF)0.5f)));
}

#endif
