// SPDX-License-Identifier: MIT
// LANES small triangles at once: the arithmetic of lib/raster.h, bit for bit, in 32-bit integers, which
// hold it for extents up to RASTER_SMALL. What is larger or has to be clipped is left to lib/raster.h.
#ifndef LIB_RASTER_LANES_H
#define LIB_RASTER_LANES_H
#include "lib/lanes.h"
#include "lib/raster.h"

#ifndef RASTER_CHUNK
#ifdef ON_CPU
#define RASTER_CHUNK 64  // triangles of a work-item
#else
#define RASTER_CHUNK 1
#endif
#endif

/// Corners in 1/256 pixel with depths; clockwise on the screen from laneOrient on.
typedef struct {
    VI x[3], y[3];
    VF depth[3];
    VI area;  ///< before orienting
    VI minX, minY, maxX, maxY;
} LaneTriangles;

inline void laneArea(LaneTriangles* t) {
    t->area = (t->x[1] - t->x[0]) * (t->y[2] - t->y[0]) - (t->x[2] - t->x[0]) * (t->y[1] - t->y[0]);
}

inline void laneBox(LaneTriangles* t, int width, int height, int conservative) {
    const int midpoint = conservative ? 0 : 1 << (RASTER_SUBPIXEL_BITS - 1), below = conservative ? 0 : midpoint - 1;
    const VI left = min(t->x[0], min(t->x[1], t->x[2])), right = max(t->x[0], max(t->x[1], t->x[2]));
    const VI top = min(t->y[0], min(t->y[1], t->y[2])), bottom = max(t->y[0], max(t->y[1], t->y[2]));
    t->minX = max((left + below) >> RASTER_SUBPIXEL_BITS, (VI)0);
    t->minY = max((top + below) >> RASTER_SUBPIXEL_BITS, (VI)0);
    t->maxX = min((right - midpoint) >> RASTER_SUBPIXEL_BITS, (VI)(width - 1));
    t->maxY = min((bottom - midpoint) >> RASTER_SUBPIXEL_BITS, (VI)(height - 1));
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

/// Edge i's value at pixel (minX, minY); its steps per column and row are -dy and dx.
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

/// The walk of LANES triangles over the pixels of their boxes.
typedef struct {
    LaneDepth depth;
    VI e[3], stepX[3], stepY[3];
    VI x, y, minX, maxX, maxY, active;
} LaneWalk;

/// `t` with its area and box.
inline void laneBegin(LaneWalk* walk, LaneTriangles* t, VI active, int conservative) {
    laneOrient(t);
    for (int i = 0; i < 3; ++i) walk->e[i] = laneEdge(t, i, conservative, &walk->stepX[i], &walk->stepY[i]);
    walk->depth = laneDepth(t);
    walk->x = walk->minX = t->minX;
    walk->y = t->minY;
    walk->maxX = t->maxX;
    walk->maxY = t->maxY;
    walk->active = active;
}

/// Lanes whose pixel is covered.
inline VI laneCovered(const LaneWalk* walk) {
    return walk->active & V_MASK((walk->e[0] | walk->e[1] | walk->e[2]) >= 0);
}

/// To the next column, or to the first one of the next row.
inline void laneStep(LaneWalk* walk) {
    const VI turn = V_MASK(walk->x >= walk->maxX), back = walk->maxX - walk->minX;
    for (int i = 0; i < 3; ++i)
        walk->e[i] += V_SELECT(walk->stepX[i], walk->stepY[i] - back * walk->stepX[i], turn);
    walk->x = V_SELECT(walk->x + 1, walk->minX, turn);
    walk->y -= turn;
    walk->active &= V_MASK(walk->y <= walk->maxY);
}

#if LANES > 1
inline VF laneDot(float4 row, VF x, VF y, VF z) {
    return fma((VF)row.x, x, fma((VF)row.y, y, fma((VF)row.z, z, (VF)row.w)));
}

/// The flags of the lanes' draws; nearly always those of one.
inline VU laneFlags(global const uint* triangleDraw, global const Draw* draws, VI triangle) {
    const VU draw = V_GATHER_(VU, triangleDraw, triangle);
    if (V_ALL(V_MASK(draw == draw.s0))) return (VU)draws[draw.s0].flags;
    uint flags[LANES];
    V_STORE(draw, flags, 0);
    for (int lane = 0; lane < LANES; ++lane) flags[lane] = draws[flags[lane]].flags;
    return V_LOAD(flags, 0);
}

/// Projects corners and snaps them; returns the lanes that rasterClassify lets pass. *whole: those that need no
/// clipping.
inline VI laneProject(const RasterView* view, global const float* positions, global const uint* indices,
                      VI triangle, LaneTriangles* t, VI* whole) {
    const float scale = (float)(1 << RASTER_SUBPIXEL_BITS);
    VI left = (VI)-1, right = (VI)-1, top = (VI)-1, bottom = (VI)-1, near = (VI)-1, sane = (VI)-1;
    *whole = (VI)-1;
    for (int i = 0; i < 3; ++i) {
        const VI slot = 3 * V_AS_INT(V_GATHER_NEAR(VU, indices, 3 * triangle, i));
        const VF px = V_GATHER_NEAR(VF, positions, slot, 0), py = V_GATHER_NEAR(VF, positions, slot, 1),
                 pz = V_GATHER_NEAR(VF, positions, slot, 2);
        const VF x = laneDot(view->rowX, px, py, pz), y = laneDot(view->rowY, px, py, pz),
                 w = laneDot(view->rowW, px, py, pz), d = laneDot(view->rowD, px, py, pz);
        left &= V_MASK(x < 0.0f);
        right &= V_MASK(x > (float)view->width * w);
        top &= V_MASK(y < 0.0f);
        bottom &= V_MASK(y > (float)view->height * w);
        near &= V_MASK(d > w);
        sane &= V_MASK(fabs(x) < 1e30f) & V_MASK(fabs(y) < 1e30f) & V_MASK(fabs(w) < 1e30f);
        const VF guard = RASTER_GUARD * w;
        *whole &= V_MASK(w - d >= 0.0f) & V_MASK(guard + x >= 0.0f) & V_MASK(guard - x >= 0.0f) &
                  V_MASK(guard + y >= 0.0f) & V_MASK(guard - y >= 0.0f);
        const VF inverse = 1.0f / w;
        t->x[i] = V_TO_INT(rint(x * inverse * scale));
        t->y[i] = V_TO_INT(rint(y * inverse * scale));
        t->depth[i] = d * inverse;
    }
    return sane & ~(left | right | top | bottom | near);
}

/// Of the triangles [first, end), at most LANES: *drawn are opaque, small, face the right way and may cover a
/// pixel; `t` has their corners and boxes. Returns the lanes that lib/raster.h has to look at.
inline VI laneTriangles(const RasterView* view, global const float* positions, global const uint* indices,
                        global const uint* triangleDraw, global const Draw* draws, uint first, uint end,
                        LaneTriangles* t, VI* drawn) {
    // Past the end lanes repeat the last triangle
    const VI triangle = min((VI)(int)first + V_INDEX, (VI)(int)(end - 1));
    const VU flags = laneFlags(triangleDraw, draws, triangle);
    VI kept = V_MASK(V_INDEX < (VI)(int)(end - first)) & V_MASK((flags & view->requireFlags) == view->requireFlags);
    *drawn = (VI)0;
    if (!V_ANY(kept)) return kept;
    VI whole;
    kept &= laneProject(view, positions, indices, triangle, t, &whole);
    const VI limit = (VI)(RASTER_SMALL << RASTER_SUBPIXEL_BITS);
    whole &= V_MASK(max(t->x[0], max(t->x[1], t->x[2])) - min(t->x[0], min(t->x[1], t->x[2])) <= limit) &
             V_MASK(max(t->y[0], max(t->y[1], t->y[2])) - min(t->y[0], min(t->y[1], t->y[2])) <= limit);
    laneArea(t);
    laneBox(t, view->width, view->height, view->conservative);
    const VI clockwise = V_MASK(t->area > 0) ^ V_MASK((flags & DRAW_MIRRORED) != 0);
    const VI front = view->frontIsClockwise ? clockwise : ~clockwise;
    const VU culls = V_SELECT((VU)view->cullBack, (VU)view->cullFront, V_AS_UINT(front));
    const VI culled = V_MASK((flags & view->keepBoth) == 0) & V_MASK((flags & culls) != 0);
    const VI covers = V_MASK(t->area != 0) & ~culled & V_MASK(t->minX <= t->maxX) & V_MASK(t->minY <= t->maxY);
    kept &= covers | ~whole;
    *drawn = kept & whole & V_MASK((flags & (DRAW_MASK | DRAW_BLEND)) == 0);
    return kept & ~*drawn;
}

/// Triangles that wait until there are enough of them to fill all lanes.
typedef struct {
    int x[3][RASTER_CHUNK + LANES], y[3][RASTER_CHUNK + LANES], triangle[RASTER_CHUNK + LANES];
    float depth[3][RASTER_CHUNK + LANES];
    int count;
} LaneQueue;

inline void lanePush(LaneQueue* queue, const LaneTriangles* t, VI drawn, uint first) {
    int x[3][LANES], y[3][LANES], mask[LANES];
    float depth[3][LANES];
    V_STORE(drawn, mask, 0);
    for (int i = 0; i < 3; ++i) {
        V_STORE(t->x[i], x[i], 0);
        V_STORE(t->y[i], y[i], 0);
        V_STORE(t->depth[i], depth[i], 0);
    }
    for (int lane = 0; lane < LANES; ++lane) {
        if (!mask[lane]) continue;
        const int slot = queue->count++;
        queue->triangle[slot] = (int)first + lane;
        for (int i = 0; i < 3; ++i) {
            queue->x[i][slot] = x[i][lane];
            queue->y[i][slot] = y[i][lane];
            queue->depth[i][slot] = depth[i][lane];
        }
    }
}

/// The queue's triangles from `first` on, ready for laneBegin.
inline LaneTriangles laneAt(const LaneQueue* queue, int first, const RasterView* view) {
    LaneTriangles t;
    for (int i = 0; i < 3; ++i) {
        t.x[i] = V_LOAD(queue->x[i], first);
        t.y[i] = V_LOAD(queue->y[i], first);
        t.depth[i] = V_LOAD(queue->depth[i], first);
    }
    laneArea(&t);
    laneBox(&t, view->width, view->height, view->conservative);
    return t;
}
#endif

#endif
