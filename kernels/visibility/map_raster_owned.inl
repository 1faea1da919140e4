// SPDX-License-Identifier: MIT
// map_raster with each map owned by one work-item; paste with OWNED_TEXEL, OWNED and OWNED_KERNEL defined.

/// Keeps the nearest depth at the lanes' texels.
inline void OWNED(mapStore)(global OWNED_TEXEL* map, VI texel, VU bits, VI covered) {
    int texels[LANES], mask[LANES];
    uint values[LANES];
    V_STORE(texel, texels, 0);
    V_STORE(bits, values, 0);
    V_STORE(covered, mask, 0);
    for (int lane = 0; lane < LANES; ++lane)
        if (mask[lane] && map[texels[lane]] < values[lane]) map[texels[lane]] = (OWNED_TEXEL)values[lane];
}

/// Draws LANES small triangles of the shared list, in lockstep over each one's own box.
inline void OWNED(mapDrawLanes)(const MultiViewParams* light, const MapRasterParams* p, float kx, float ky,
                                global const float* restrict triangles, VI index, VI active,
                                global OWNED_TEXEL* map) {
    VF a[3], b[3], w[3];
    for (int i = 0; i < 3; ++i) {
        a[i] = V_GATHER_(VF, triangles + (size_t)(3 * i) * p->capacity, index);
        b[i] = V_GATHER_(VF, triangles + (size_t)(3 * i + 1) * p->capacity, index);
        w[i] = V_GATHER_(VF, triangles + (size_t)(3 * i + 2) * p->capacity, index);
    }
    LaneTriangles t;
    laneSnap(&t, a, b, w, kx, ky);
    laneBox(&t, light->resolution, light->resolution, p->conservative);
    LaneWalk walk;
    laneBegin(&walk, &t, active, p->conservative);
    const VF bias = fma((VF)p->biasSlope, max(fabs(walk.depth.depthX), fabs(walk.depth.depthY)), (VF)p->biasConstant);
    for (; V_ANY(walk.active); laneStep(&walk)) {
        const VI covered = laneCovered(&walk);
        if (!V_ANY(covered)) continue;
        const VF depth = laneDepthAt(&walk.depth, walk.x, walk.y) - bias;
        OWNED(mapStore)(map, walk.y * light->resolution + walk.x, laneBits(light, depth), covered);
    }
}

#ifndef MAP_OWNED_CHUNK
#define MAP_OWNED_CHUNK 256  // triangles tested before the rest of them is drawn
#endif

/// Draws all small opaque triangles: those that may cover a texel are gathered first, so that lanes are full.
inline void OWNED(mapDrawPlain)(const MultiViewParams* light, const MapRasterParams* p, float kx, float ky,
                                uint count, global const float* restrict triangles,
                                global const uint* restrict flags, global OWNED_TEXEL* map) {
    int live[MAP_OWNED_CHUNK + 2 * LANES];
    int pending = 0;
    for (uint first = 0; first < count; first += LANES) {
        VF a[3], b[3], w[3];
        for (int i = 0; i < 3; ++i) {
            a[i] = V_LOAD(triangles, (size_t)(3 * i) * p->capacity + first);
            b[i] = V_LOAD(triangles, (size_t)(3 * i + 1) * p->capacity + first);
            w[i] = V_LOAD(triangles, (size_t)(3 * i + 2) * p->capacity + first);
        }
        LaneTriangles t;
        laneSnap(&t, a, b, w, kx, ky);
        laneBox(&t, light->resolution, light->resolution, p->conservative);
        const VI shown = laneLive(&t, V_AS_INT(V_LOAD(flags, first))) & V_MASK(V_INDEX < (VI)(int)(count - first));
        int mask[LANES];
        V_STORE(shown, mask, 0);
        for (int lane = 0; lane < LANES; ++lane) {
            live[pending] = (int)first + lane;
            pending -= mask[lane];
        }
        const int last = first + LANES >= count;
        if (pending < MAP_OWNED_CHUNK && !last) continue;
        int drawn = 0;
        for (; drawn < pending && (last || pending - drawn >= LANES); drawn += LANES) {
            const VI active = V_MASK(V_INDEX + drawn < (VI)pending);
            // Past the list's end lanes repeat its first triangle, and draw nothing
            for (int lane = pending; lane < drawn + LANES; ++lane) live[lane] = live[drawn];
            OWNED(mapDrawLanes)(light, p, kx, ky, triangles, V_LOAD(live, drawn), active, map);
        }
        for (int i = drawn; i < pending; ++i) live[i - drawn] = live[i];
        pending = max(pending - drawn, 0);
    }
}

/// A tile of an opaque triangle, LANES columns at a time. base: the edges' values at (left, top).
inline void OWNED(mapDrawTile)(const MultiViewParams* light, const MapRasterParams* p, const RasterTriangle* t,
                               int left, int top, const int* base, global OWNED_TEXEL* map) {
    const int minX = max(left, t->minX), maxX = min(left + RASTER_TILE - 1, t->maxX);
    const int minY = max(top, t->minY), maxY = min(top + RASTER_TILE - 1, t->maxY);
    const float bias = mapBias(p, t->depthX * MAP_NEAR_CLIP, t->depthY * MAP_NEAR_CLIP);
    for (int y = minY; y <= maxY; ++y)
        for (int first = minX; first <= maxX; first += LANES) {
            const VI x = V_INDEX + first;
            VI inside = V_MASK(x <= maxX);
            for (int i = 0; i < 3; ++i)
                inside &= V_MASK(base[i] + t->edge[i].a * (x - left) + t->edge[i].b * (y - top) >= 0);
            if (!V_ANY(inside)) continue;
            const VF depth = fma((VF)t->depthX, V_TO_FLOAT(x) - t->x0,
                                 fma((VF)t->depthY, (VF)((float)y - t->y0), (VF)t->depth0));
            const VF kept = clamp(depth, (VF)t->depthMin, (VF)t->depthMax) * MAP_NEAR_CLIP - bias;
            OWNED(mapStore)(map, y * light->resolution + x, laneBits(light, kept), inside);
        }
}

/// A triangle whose fragments need their own look, and the buffers to look into.
typedef struct {
    const MultiViewParams* light;
    const MapRasterParams* params;
    const Draw* draw;
    uint drawIndex, triangle;
    const RasterVertex* v;
    global const Material* materials;
    global const uint* indices;
    global const float* uvs;
    global const uint* colours;
    global const uint* texels;
} OWNED(MaskedTriangle);

/// A tile of a masked or blended triangle, texel by texel.
inline void OWNED(mapDrawMasked)(const OWNED(MaskedTriangle)* m, const RasterTriangle* t, int left, int top,
                                 const int* base, global OWNED_TEXEL* map) {
    const int maxX = min(left + RASTER_TILE - 1, t->maxX), maxY = min(top + RASTER_TILE - 1, t->maxY);
    const float bias = mapBias(m->params, t->depthX * MAP_NEAR_CLIP, t->depthY * MAP_NEAR_CLIP);
    for (int y = max(top, t->minY); y <= maxY; ++y)
        for (int x = max(left, t->minX); x <= maxX; ++x) {
            int inside = 1;
            for (int i = 0; i < 3; ++i)
                inside &= base[i] + t->edge[i].a * (x - left) + t->edge[i].b * (y - top) >= 0;
            if (!inside || !mapBlocks(m->light, m->draw, m->drawIndex, m->params->view, m->materials, m->indices,
                                      m->uvs, m->colours, m->texels, m->triangle, m->v, x, y))
                continue;
            const uint bits = mapBits(m->light, rasterDepth(t, x, y) * MAP_NEAR_CLIP - bias);
            global OWNED_TEXEL* texel = &map[y * m->light->resolution + x];
            if (*texel < bits) *texel = (OWNED_TEXEL)bits;
        }
}

/// Draws one triangle of the special list: tile by tile, as the rasteriser core does with large ones.
inline void OWNED(mapDrawSpecial)(const RasterView* view, const OWNED(MaskedTriangle)* m, global OWNED_TEXEL* map) {
    RasterVertex corners[RASTER_MAX_CORNERS];
    for (int k = 0; k < 3; ++k) corners[k] = m->v[k];
    const int kind = rasterClassify(view, m->v);
    if (kind == RASTER_REJECT) return;
    const int count = kind == RASTER_CLIP ? rasterClip(corners) : 3;
    for (int part = 0; part + 2 < count; ++part) {
        RasterTriangle t;
        if (!rasterSetup(view, m->draw->flags, corners[0], corners[part + 1], corners[part + 2], &t)) continue;
        for (int top = t.minY / RASTER_TILE * RASTER_TILE; top <= t.maxY; top += RASTER_TILE)
            for (int left = t.minX / RASTER_TILE * RASTER_TILE; left <= t.maxX; left += RASTER_TILE) {
                int base[3];
                if (rasterTileOutside(&t, left, top, base)) continue;
                if (m->draw->flags & (DRAW_MASK | DRAW_BLEND))
                    OWNED(mapDrawMasked)(m, &t, left, top, base, map);
                else
                    OWNED(mapDrawTile)(m->light, m->params, &t, left, top, base, map);
            }
    }
}

/// One work-item per view of the batch: clears its map, then draws all triangles of the shared lists into it.
kernel void OWNED_KERNEL(const RasterView view, const MultiViewParams light, const MapRasterParams batch,
                         global const float* restrict positions, global const uint* restrict indices,
                         global const uint* restrict triangleDraw, global const Draw* restrict draws
                         CASTER_ALPHA_PARAMETERS, global const float* restrict vertices,
                         global const float* restrict triangles, global const uint* restrict flags,
                         global const uint* restrict specials, global const MapRasterCounts* restrict counts,
                         global const float* restrict samples, global OWNED_TEXEL* restrict maps) {
    const int item = get_global_id(0);
    if (item >= batch.viewCount) return;
    MapRasterParams params = batch;
    params.view = batch.firstView + item;
    params.kx = params.shiftX = samples[2 * params.view];
    params.ky = params.shiftY = samples[2 * params.view + 1];
    global OWNED_TEXEL* map = maps + (size_t)item * light.mapStride;
    for (int i = 0; i < light.mapStride; ++i) map[i] = 0;
    OWNED(mapDrawPlain)(&light, &params, params.kx, params.ky, counts->plain, triangles, flags, map);
    for (uint i = 0; i < counts->special; ++i) {
        const uint triangle = specials[i], drawIndex = triangleDraw[triangle];
        const Draw draw = draws[drawIndex];
        RasterVertex v[3];
        mapVertices(&view, &params, vertices, positions, indices, triangle, v);
        const OWNED(MaskedTriangle) special = {&light, &params, &draw, drawIndex, triangle, v,
                                               materials, indices, uvs, colours, texels};
        OWNED(mapDrawSpecial)(&view, &special, map);
    }
}
#undef OWNED_TEXEL
#undef OWNED
#undef OWNED_KERNEL
