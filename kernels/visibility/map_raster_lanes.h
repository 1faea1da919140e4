// SPDX-License-Identifier: MIT
// LANES small triangles of one of a light's views at once.
#ifndef MAP_RASTER_LANES_H
#define MAP_RASTER_LANES_H
#include "lib/raster_lanes.h"
#include "shared/map_raster.h"
#include "shared/multi_view.h"

/// Snaps corners of one view: u = a - kx w, v = b - ky w.
inline void laneSnap(LaneTriangles* t, const VF* a, const VF* b, const VF* w, float kx, float ky) {
    const float scale = (float)(1 << RASTER_SUBPIXEL_BITS);
    for (int i = 0; i < 3; ++i) {
        t->x[i] = V_TO_INT(rint(fma((VF)-kx, w[i], a[i]) * scale));
        t->y[i] = V_TO_INT(rint(fma((VF)-ky, w[i], b[i]) * scale));
        t->depth[i] = w[i];
    }
    laneArea(t);
}

/// Lanes that are not culled, not degenerate, and may cover a texel.
inline VI laneLive(const LaneTriangles* t, VI flags) {
    const VI clockwise = V_MASK(t->area > 0), counterclockwise = V_MASK(t->area < 0);
    const VI dropped = (clockwise & V_MASK((flags & (int)MAP_DROP_CLOCKWISE) != 0)) |
                       (counterclockwise & V_MASK((flags & (int)MAP_DROP_COUNTERCLOCKWISE) != 0));
    return (clockwise | counterclockwise) & ~dropped & V_MASK(t->minX <= t->maxX) & V_MASK(t->minY <= t->maxY);
}

inline VU laneBits(const MultiViewParams* light, VF depth) {
    depth = clamp(depth, (VF)0.0f, (VF)1.0f);
    return light->depthBits == 32 ? V_AS_UINT(depth) : V_AS_UINT(V_TO_INT(fma(depth, (VF)65535.0f, (VF)0.5f)));
}

#endif
