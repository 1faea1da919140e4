// SPDX-License-Identifier: MIT
// The rasteriser core; paste it once per fragment action. Before the paste define
//   RASTER_KERNEL       name of the first kernel; the second is RASTER_KERNEL_LARGE
//   RASTER_PARAMETERS   further kernel parameters, with a leading comma; may be empty
//   RASTER_BEGIN        statements at a work-item's start (local variables of the action)
//   RASTER_TRIANGLE     statements before a triangle's fragments; only with RASTER_VERTICES, since lanes hold many
//                       triangles at a time
//   RASTER_FRAGMENT     statements per fragment; they see x, y, depth, triangle, draw, v (vertices
//                       before clipping; only of masked or blended draws) and the kernel's parameters
//   RASTER_END          statements at a work-item's end
//   RASTER_VERTICES     (optional) statements that fill v[3]; default: `view` applied to positions
//
//   triangles --small--> fragments
//             --large--> list of (triangle, tile) --one work-group each--> fragments
// The list's counter counts past its capacity without writing: the host grows it and repeats.
// Fragments come in no fixed order; actions must commute.

#ifndef RASTER_VERTICES_OF_VIEW
#include "lib/raster_lanes.h"

#define RASTER_VERTICES_OF_VIEW \
    for (int i = 0; i < 3; ++i) v[i] = rasterVertex(&view, positions, indices[3 * triangle + i]);

inline void rasterAppendTiles(const RasterView* view, global uint* tileCount, global RasterTile* tiles,
                              const RasterTriangle* t, uint triangle, uint part) {
    const int left = t->minX / RASTER_TILE, right = t->maxX / RASTER_TILE;
    const int top = t->minY / RASTER_TILE, bottom = t->maxY / RASTER_TILE;
    const uint wanted = (uint)(right - left + 1) * (uint)(bottom - top + 1);
    uint slot = atomic_add(tileCount, wanted);
    for (int row = top; row <= bottom; ++row)
        for (int column = left; column <= right; ++column, ++slot) {
            if (slot >= view->tileCapacity) continue;
            tiles[slot].triangle = triangle;
            tiles[slot].tile = (uint)(row * 512 + column) | part << 28;
        }
}
#endif
#ifndef RASTER_VERTICES
#define RASTER_VERTICES RASTER_VERTICES_OF_VIEW
#if LANES > 1
#define RASTER_IN_LANES
#endif
#endif

/// One work-item per RASTER_CHUNK triangles: draws the small ones, lists the tiles of the others. In lanes, small
/// opaque triangles wait in a queue.
kernel void RASTER_KERNEL(const RasterView view, global const float* restrict positions,
                          global const uint* restrict indices, global const uint* restrict triangleDraw,
                          global const Draw* restrict draws, global uint* tileCount,
                          global RasterTile* restrict tiles RASTER_PARAMETERS) {
    const uint begin = (uint)get_global_id(0) * RASTER_CHUNK;
    const uint end = min(begin + RASTER_CHUNK, (uint)view.triangleCount);
    RASTER_BEGIN
#ifdef RASTER_IN_LANES
    LaneQueue queue;
    queue.count = 0;
#endif
    for (uint first = begin; first < end; first += LANES) {
#ifdef RASTER_IN_LANES
        LaneTriangles lanes;
        VI drawn;
        const VI others = laneTriangles(&view, positions, indices, triangleDraw, draws, first, end, &lanes, &drawn);
        if (V_ANY(drawn)) lanePush(&queue, &lanes, drawn, first);
        if (!V_ANY(others)) continue;
#else
        const VI others = V_MASK((VI)(int)first + V_INDEX < (VI)(int)end);
#endif
        int mask[LANES];
        V_STORE(others, mask, 0);
        for (int lane = 0; lane < LANES; ++lane) {
            if (!mask[lane]) continue;
            const uint triangle = first + (uint)lane;
            const uint drawIndex = triangleDraw[triangle];
            const Draw draw = draws[drawIndex];
            if ((draw.flags & view.requireFlags) != view.requireFlags) continue;
            RasterVertex v[3];
            RASTER_VERTICES
            const int kind = rasterClassify(&view, v);
            if (kind == RASTER_REJECT) continue;
            RasterTriangle t;
            if (kind == RASTER_CLIP) {
                RasterVertex corners[RASTER_MAX_CORNERS];
                for (int i = 0; i < 3; ++i) corners[i] = v[i];
                const int count = rasterClip(corners);
                for (int part = 0; part + 2 < count; ++part)
                    if (rasterSetup(&view, draw.flags, corners[0], corners[part + 1], corners[part + 2], &t))
                        rasterAppendTiles(&view, tileCount, tiles, &t, triangle, (uint)part);
                continue;
            }
            if (!rasterSetup(&view, draw.flags, v[0], v[1], v[2], &t)) continue;
            if (!t.small) {
                rasterAppendTiles(&view, tileCount, tiles, &t, triangle, 0);
                continue;
            }
            RASTER_TRIANGLE
            int e0 = rasterEdgeAt(t.edge[0], t.minX, t.minY);
            int e1 = rasterEdgeAt(t.edge[1], t.minX, t.minY);
            int e2 = rasterEdgeAt(t.edge[2], t.minX, t.minY);
            for (int y = t.minY; y <= t.maxY; ++y) {
                for (int x = t.minX; x <= t.maxX; ++x) {
                    if ((e0 | e1 | e2) >= 0) {
                        const float depth = rasterDepth(&t, x, y);
                        RASTER_FRAGMENT
                    }
                    e0 += t.edge[0].a;
                    e1 += t.edge[1].a;
                    e2 += t.edge[2].a;
                }
                const int back = t.maxX - t.minX + 1;
                e0 += t.edge[0].b - back * t.edge[0].a;
                e1 += t.edge[1].b - back * t.edge[1].a;
                e2 += t.edge[2].b - back * t.edge[2].a;
            }
        }
    }
#ifdef RASTER_IN_LANES
    for (int first = 0; first < queue.count; first += LANES) {
        LaneTriangles lanes = laneAt(&queue, first, &view);
        LaneWalk walk;
        laneBegin(&walk, &lanes, V_MASK(V_INDEX < (VI)(queue.count - first)), view.conservative);
        for (; V_ANY(walk.active); laneStep(&walk)) {
            const VI covered = laneCovered(&walk);
            if (!V_ANY(covered)) continue;
            int mask[LANES], columns[LANES], rows[LANES];
            float depths[LANES];
            V_STORE(covered, mask, 0);
            V_STORE(walk.x, columns, 0);
            V_STORE(walk.y, rows, 0);
            V_STORE(laneDepthAt(&walk.depth, walk.x, walk.y), depths, 0);
            for (int lane = 0; lane < LANES; ++lane) {
                if (!mask[lane]) continue;
                const int x = columns[lane], y = rows[lane];
                const float depth = depths[lane];
                const uint triangle = (uint)queue.triangle[first + lane], drawIndex = triangleDraw[triangle];
                const Draw draw = draws[drawIndex];
                const RasterVertex v[3] = {{0}};
                RASTER_FRAGMENT
            }
        }
    }
#endif
    RASTER_END
}

/// Work-groups take the listed tiles in turn; their work-items share a tile's columns.
kernel void RASTER_KERNEL_LARGE(const RasterView view, global const float* restrict positions,
                                global const uint* restrict indices,
                                global const uint* restrict triangleDraw,
                                global const Draw* restrict draws, global const uint* tileCount,
                                global const RasterTile* restrict tiles RASTER_PARAMETERS) {
    const uint count = min(*tileCount, view.tileCapacity);
    RASTER_BEGIN
    for (uint job = get_group_id(0); job < count; job += get_num_groups(0)) {
        const uint triangle = tiles[job].triangle;
        const uint tile = tiles[job].tile & 0x0fffffffu, part = tiles[job].tile >> 28;
        const uint drawIndex = triangleDraw[triangle];
        const Draw draw = draws[drawIndex];
        RasterVertex v[3], corners[RASTER_MAX_CORNERS];
        RASTER_VERTICES
        for (int i = 0; i < 3; ++i) corners[i] = v[i];
        if (rasterClassify(&view, v) == RASTER_CLIP) rasterClip(corners);
        RasterTriangle t;
        if (!rasterSetup(&view, draw.flags, corners[0], corners[part + 1], corners[part + 2], &t))
            continue;
        const int left = (int)(tile % 512) * RASTER_TILE, top = (int)(tile / 512) * RASTER_TILE;
        const int minX = max(left, t.minX), maxX = min(left + RASTER_TILE - 1, t.maxX);
        const int minY = max(top, t.minY), maxY = min(top + RASTER_TILE - 1, t.maxY);
        int base[3];
        if (rasterTileOutside(&t, left, top, base)) continue;
        RASTER_TRIANGLE
        const int step = (int)get_local_size(0), first = minX + (int)get_local_id(0);
        for (int y = minY; y <= maxY; ++y) {
            int e0 = base[0] + t.edge[0].a * (first - left) + t.edge[0].b * (y - top);
            int e1 = base[1] + t.edge[1].a * (first - left) + t.edge[1].b * (y - top);
            int e2 = base[2] + t.edge[2].a * (first - left) + t.edge[2].b * (y - top);
            for (int x = first; x <= maxX; x += step) {
                if ((e0 | e1 | e2) >= 0) {
                    const float depth = rasterDepth(&t, x, y);
                    RASTER_FRAGMENT
                }
                e0 += t.edge[0].a * step;
                e1 += t.edge[1].a * step;
                e2 += t.edge[2].a * step;
            }
        }
    }
    RASTER_END
}

#undef RASTER_KERNEL
#undef RASTER_KERNEL_LARGE
#undef RASTER_PARAMETERS
#undef RASTER_BEGIN
#undef RASTER_TRIANGLE
#undef RASTER_FRAGMENT
#undef RASTER_END
#undef RASTER_VERTICES
#undef RASTER_IN_LANES
