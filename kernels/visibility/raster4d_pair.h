// SPDX-License-Identifier: MIT
// Pairs of a receiver and a triangle that rows of intervals do not decide: samples off the centres of their
// cells, and opacity that varies over the triangle.
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

/// True positions of samples, in grid coordinates, and which cells have one.
typedef struct {
    global const float* x;     ///< [row * columns + column]
    global const float* y;
    global const int* sample;  ///< index of the light sample, -1: none
} MaskCells;

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

/// Rows first to last of one lane's triangle, sample by sample.
inline void pairSamples(const Raster4dParams* p, const MaskEnds* e, int lane, int planes, int first, int last,
                        uint triangle, const MaskCells* cells, const MaskSurfaces* surfaces, uint* mask) {
    const int surface = (triangle & R4_SURFACE) != 0;
    for (int row = first; row <= last; ++row) {
        const float2 columns = maskColumns(p, e, lane, planes, (float)row, p->slack);
        if (!(columns.x <= columns.y)) continue;
        const int stop = (int)columns.y;
        for (int column = (int)ceil(columns.x); column <= stop; ++column) {
            uint* word = mask + (column >> 5) * MASK_STRIDE + row;
            const uint bit = 1u << (column & 31);
            const int cell = row * p->columns + column;
            if ((*word & bit) || cells->sample[cell] < 0) continue;
            float at[4];
            int inside = 1;
            for (int k = 0; k < 4; ++k) {
                at[k] = fma(e->a[k][lane], cells->x[cell], fma(e->b[k][lane], cells->y[cell], e->c[k][lane]));
                inside &= k >= planes || at[k] >= 0.0f;
            }
            if (!p->centred && !inside) continue;
            // Opposite to corner 0 lies edge (1,2)
            const float3 b = (float3)(at[1], at[2], at[0]) / (at[0] + at[1] + at[2]);
            if (surface && !surfaceBlocks(p, surfaces, triangle & ~R4_SURFACE, b, cells->sample[cell])) continue;
            *word |= bit;
        }
    }
}

#endif
