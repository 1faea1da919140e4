// SPDX-License-Identifier: MIT
// Which light samples a triangle hides from a receiver: a bit each, a row at a time.
// Source: [4DR] 3.3 and algorithm 3. Seen from the receiver q, the plane through q and an edge cuts the
// light's plane in a line, E(j, i) = A j + B i + C, and sample (i, j) is hidden if it lies on the inner side
// of all three. A row's hidden columns are therefore an interval whose ends are linear in the row:
// j = -(B / A) i - C / A, the largest of the left ends to the least of the right ones.
// Differs: an edge is measured from the corner that comes first in space, along end less start. Its plane is then
// the same, but for the sign, in the two triangles that share it, so that no sample falls between them; and far
// receivers lose no digits to a cross product of two long vectors. Samples on an edge are hidden. The
// triangle's own plane ([4DR] P3) is looked at only where a corner is farther from the light than q.
#ifndef LIB_OCCLUSION_MASK_H
#define LIB_OCCLUSION_MASK_H
#include "lib/lanes.h"
#include "shared/raster4d.h"

// Words of a mask in private memory: rows of word 0, then of word 1; a vector may run past the last row
#define MASK_STRIDE (R4_ROWS + 16)
#define MASK_WORDS (2 * MASK_STRIDE)
#define MASK_BEYOND 1e30f

/// The lines that a triangle's edges, and in lane 3 its plane, draw on the light; inside is >= 0.
typedef struct {
    float4 a, b, c;
} MaskLines;

/// 0 if q lies in the triangle's plane: nothing is hidden then.
inline int maskLines(float3 q, global const float4* restrict t, MaskLines* lines) {
    const float4 baseX = t[R4_BASE], baseY = t[R4_BASE + 1], baseZ = t[R4_BASE + 2];
    const float4 edgeX = t[R4_EDGE], edgeY = t[R4_EDGE + 1], edgeZ = t[R4_EDGE + 2];
    const float4 x = baseX - q.x, y = baseY - q.y, z = baseZ - q.z;
    const float above = fma(x.w, edgeX.w, fma(y.w, edgeY.w, z.w * edgeZ.w));
    if (!(fabs(above) > 0.0f)) return 0;
    // No fma here: the products must cancel alike in both triangles of an edge
    const float side = above > 0.0f ? 1.0f : -1.0f;
    lines->a = (y * edgeZ - z * edgeY) * side;
    lines->b = (z * edgeX - x * edgeZ) * side;
    const float4 n = (x * edgeY - y * edgeX) * side;
    lines->c = -fma(lines->a, baseX, fma(lines->b, baseY, n * baseZ));
    // Hidden samples lie beyond the plane, where the receiver does not
    lines->a.w = edgeX.w * side;
    lines->b.w = edgeY.w * side;
    lines->c.w = t[R4_FARTHEST].z * side;
    return 1;
}

/// Ends of rows as linear functions: column = slope x row + start, of each lane.
typedef struct {
    float4 slope, start;
    int4 left;  ///< lanes whose inner side is to the right
} MaskEnds;

inline MaskEnds maskEnds(const MaskLines* lines) {
    MaskEnds e;
    // A line along a row: its end is far to the left or to the right, by the side that the row lies on
    const float4 least = fma(fabs(lines->b), (float4)64.0f, fabs(lines->c)) * 1e-18f + 1e-37f;
    e.left = lines->a >= 0.0f;
    const float4 a = select(min(lines->a, -least), max(lines->a, least), e.left);
    e.slope = -lines->b / a;
    e.start = -lines->c / a;
    return e;
}

/// Bits of columns in [left, right] of word `word`; left >= 0.
inline VU maskBits(VF left, VF right, int word) {
    const float first = (float)(32 * word);
    const VF from = max(left - first, (VF)0.0f), to = min(right - first, (VF)31.0f);
    const VI inside = V_MASK(from <= to);
    const VI start = V_SELECT((VI)0, V_TO_INT(ceil(from)), inside);
    const VI stop = V_SELECT((VI)0, V_TO_INT(floor(to)), inside);
    return ((VU)0xffffffffu << V_AS_UINT(start & 31)) & ((VU)0xffffffffu >> V_AS_UINT((31 - stop) & 31)) &
           V_AS_UINT(inside);
}

/// Rows first to last, LANES at a time. planes: 3, or 4 with the triangle's own.
inline void maskRows(const Raster4dParams* p, const MaskEnds* e, int planes, int first, int last, uint* mask) {
    const float4 zero = (float4)0.0f, far = (float4)MASK_BEYOND;
    const float4 leftSlope = select(zero, e->slope, e->left), leftStart = select(-far, e->start, e->left);
    const float4 rightSlope = select(e->slope, zero, e->left), rightStart = select(e->start, far, e->left);
    const VF columns = (VF)(float)(p->columns - 1), end = (VF)(float)last;
    for (int row = first; row <= last; row += LANES) {
        const VF i = V_TO_FLOAT(V_INDEX + row);
        VF left = max(max(fma((VF)leftSlope.x, i, (VF)leftStart.x), fma((VF)leftSlope.y, i, (VF)leftStart.y)),
                      max(fma((VF)leftSlope.z, i, (VF)leftStart.z), (VF)0.0f));
        VF right = min(min(fma((VF)rightSlope.x, i, (VF)rightStart.x), fma((VF)rightSlope.y, i, (VF)rightStart.y)),
                       min(fma((VF)rightSlope.z, i, (VF)rightStart.z), columns));
        if (planes > 3) {
            left = max(left, fma((VF)leftSlope.w, i, (VF)leftStart.w));
            right = min(right, fma((VF)rightSlope.w, i, (VF)rightStart.w));
        }
        right = V_SELECT((VF)-1.0f, right, V_MASK(i <= end));
        for (int word = 0; word < p->words; ++word) {
            uint* rows = mask + word * MASK_STRIDE + row;
            V_STORE(V_LOAD(rows, 0) | maskBits(left, right, word), rows, 0);
        }
    }
}

/// True positions of samples within their cells, and which cells have one.
typedef struct {
    global const float* x;  ///< [row * columns + column]
    global const float* y;
    global const int* sample;  ///< index of the light sample, -1: none
} MaskCells;

/// One row as an interval that holds every column which may be hidden, whatever the corners' distances;
/// `slack`: how far a sample lies from the centre of its cell.
inline void maskRow(const MaskEnds* e, int planes, int row, float slack, float columns,
                    float* left, float* right) {
    *left = 0.0f;
    *right = columns - 1.0f;
    const float slopes[4] = {e->slope.x, e->slope.y, e->slope.z, e->slope.w};
    const float starts[4] = {e->start.x, e->start.y, e->start.z, e->start.w};
    const int lefts[4] = {e->left.x, e->left.y, e->left.z, e->left.w};
    for (int k = 0; k < planes; ++k) {
        const float end = fma(slopes[k], (float)row, starts[k]);
        const float spread = slack > 0.0f ? slack * (1.0f + fabs(slopes[k])) + 1e-5f * fabs(end) : 0.0f;
        if (lefts[k])
            *left = max(*left, end - spread);
        else
            *right = min(*right, end + spread);
    }
}

/// E of each lane at a sample.
inline float4 maskAt(const MaskLines* lines, float x, float y) {
    return fma(lines->a, (float4)x, fma(lines->b, (float4)y, lines->c));
}

#endif
