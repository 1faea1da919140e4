// SPDX-License-Identifier: MIT
// One receiver and one triangle, whatever the light's samples and the triangle's material.
#ifndef RASTER4D_PAIR_H
#define RASTER4D_PAIR_H
#include "lib/occlusion_mask.h"
#include "lib/opacity.h"
#include "lib/texture.h"

typedef struct {
    global const uint* indices;
    global const uint* triangleDraw;
    global const Draw* draws;
    global const Material* materials;
    global const float* uvs;
    global const uint* colours;
    global const uint* texels;
} MaskSurfaces;

#define RASTER4D_SURFACES                                                                          \
    global const uint *restrict indices, global const uint *restrict triangleDraw,                 \
        global const Draw *restrict draws, global const Material *restrict materials,              \
        global const float *restrict uvs, global const uint *restrict colours, global const uint *restrict texels

/// 1 if the surface at barycentric coordinates b blocks a light sample.
inline int surfaceBlocks(const Raster4dParams* p, const MaskSurfaces* s, uint triangle, float3 b, int sample) {
    const uint drawIndex = s->triangleDraw[triangle];
    const Draw draw = s->draws[drawIndex];
    global const Material* m = &s->materials[draw.material];
    const float alpha = surfaceAlpha(&draw, m, s->indices, s->uvs, s->colours, s->texels, triangle, b);
    if (draw.flags & DRAW_MASK) return alpha >= m->alphaCutoff;
    return opacityBlocks(opacityKey(alpha * (1.0f - m->transmission), drawIndex), sample, p->samples,
                         p->sampleStride);
}

/// Rows first to last sample by sample where an interval does not decide: samples off the centres of
/// their cells, opacity that varies, and corners beyond the receiver (`planes` 4).
inline void pairSamples(const Raster4dParams* p, const MaskLines* lines, const MaskEnds* ends, int planes,
                        int first, int last, uint triangle, const MaskCells* cells, const MaskSurfaces* surfaces,
                        uint* mask) {
    const int surface = (triangle & R4_SURFACE) != 0;
    for (int row = first; row <= last; ++row) {
        float left, right;
        maskRow(ends, planes, row, p->centred ? 0.0f : 0.5f, (float)p->columns, &left, &right);
        if (!(left <= right)) continue;
        const int stop = (int)floor(right);
        for (int column = (int)ceil(left); column <= stop; ++column) {
            uint* word = mask + (column >> 5) * MASK_STRIDE + row;
            const uint bit = 1u << (column & 31);
            if (*word & bit) continue;
            const int cell = row * p->columns + column;
            if (cells->sample[cell] < 0) continue;
            if (!p->centred || surface) {
                const float4 e = maskAt(lines, cells->x[cell], cells->y[cell]);
                if (!p->centred && !(e.x >= 0.0f && e.y >= 0.0f && e.z >= 0.0f && (planes < 4 || e.w > 0.0f)))
                    continue;
                const float sum = e.x + e.y + e.z;
                if (surface && !surfaceBlocks(p, surfaces, triangle & ~R4_SURFACE,
                                              (float3)(e.y / sum, e.z / sum, e.x / sum), cells->sample[cell]))
                    continue;
            }
            *word |= bit;
        }
    }
}

/// Adds to `mask` what the triangle hides in rows first to last.
inline void maskPair(const Raster4dParams* p, float3 q, global const float4* restrict t, uint triangle, int first,
                     int last, const MaskCells* cells, const MaskSurfaces* surfaces, uint* mask) {
    MaskLines lines;
    if (!maskLines(q, t, &lines)) return;
    const int planes = t[R4_FARTHEST].w < q.z ? 3 : 4;
    if (planes == 4) {
        // None of the samples lies beyond the triangle's plane
        const float reach = lines.c.w + max(lines.a.w, 0.0f) * ((float)p->columns - 0.5f) +
                            max(lines.b.w, 0.0f) * ((float)p->rows - 0.5f) - min(lines.a.w, 0.0f) * 0.5f -
                            min(lines.b.w, 0.0f) * 0.5f;
        if (reach < 0.0f) return;
    }
    const MaskEnds ends = maskEnds(&lines);
    if (p->centred && !(triangle & R4_SURFACE))
        maskRows(p, &ends, planes, first, last, mask);
    else
        pairSamples(p, &lines, &ends, planes, first, last, triangle, cells, surfaces, mask);
}

#endif
