// SPDX-License-Identifier: MIT
// Which light samples triangles hide from a receiver: a bit each, a row at a time; LANES triangles at once for
// the edges, LANES rows at once for the bits.
// Source: [4DR] 3.3 and algorithm 3. Seen from the receiver q, the plane through q and an edge cuts the
// light's plane in a line, E(j, i) = A j + B i + C, and sample (i, j) is hidden if it lies on the inner side
// of all three. A row's hidden columns are therefore an interval whose ends are linear in the row:
// j = -(B / A) i - C / A, the largest of the left ends to the least of the right ones.
// Differs: lines come from the world's coordinates, as rays do: differences of floats lose nothing, while those of
// grid coordinates lose digits close to contact. An edge is measured from the corner that comes first in space,
// along end less start. Its plane is then the same, but for the sign, in the two triangles that share it, so that
// no sample falls between them. Samples on an edge are hidden. The triangle's own plane ([4DR] P3) is looked at
// only where a corner does not lie between light and receiver.
#ifndef LIB_OCCLUSION_MASK_H
#define LIB_OCCLUSION_MASK_H
#include "lib/lanes.h"
#include "shared/raster4d.h"

// Words of a mask in private memory: rows of word 0, then of word 1; a vector may run past the last row
#define MASK_STRIDE (R4_ROWS + 16)
#define MASK_WORDS (2 * MASK_STRIDE)
#define MASK_BEYOND 1e30f

/// A receiver in the world, and the way from it to light sample (0, 0).
typedef struct {
    float3 origin, toCorner;
} MaskOrigin;

/// LANES triangles of the world: x, y, z of corner 0, then of 1 and 2, then of the normal.
typedef struct {
    VF at[R4_WORLD];
} MaskTriangles;

/// The lines that edges (0,1), (1,2), (2,0) and, last, the triangle's own plane draw on the light; inside is >= 0.
typedef struct {
    VF a[4], b[4], c[4];
    VI valid;  ///< 0: the receiver lies in the triangle's plane, and nothing is hidden
} MaskLines;

/// Lanes where corner v precedes corner w in space.
inline VI cornerPrecedes(const VF* v, const VF* w) {
    const VI y = V_MASK(v[1] < w[1]) | (V_MASK(v[1] == w[1]) & V_MASK(v[2] < w[2]));
    return V_MASK(v[0] < w[0]) | (V_MASK(v[0] == w[0]) & y);
}

inline VF maskDot(VF x, VF y, VF z, float3 v) {
    return fma(x, (VF)v.x, fma(y, (VF)v.y, z * v.z));
}

inline MaskLines maskLines(const Raster4dParams* p, const MaskOrigin* o, const MaskTriangles* t) {
    MaskLines lines;
    // The normal n tells on which side of the triangle's plane the receiver lies
    const VF* v0 = t->at;
    const VF nx = t->at[9], ny = t->at[10], nz = t->at[11];
    const VF above =
        fma(v0[0] - o->origin.x, nx, fma(v0[1] - o->origin.y, ny, (v0[2] - o->origin.z) * nz));
    const VF side = V_SELECT((VF)-1.0f, (VF)1.0f, V_MASK(above > 0.0f));
    lines.valid = V_MASK(fabs(above) > 0.0f);
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        const VF* v = t->at + 3 * k;
        const VF* w = t->at + (k == 2 ? 0 : 3 * k + 3);
        const VI swap = cornerPrecedes(w, v);
        const VF x = V_SELECT(v[0], w[0], swap) - o->origin.x, y = V_SELECT(v[1], w[1], swap) - o->origin.y;
        const VF z = V_SELECT(v[2], w[2], swap) - o->origin.z;
        const VF ex = w[0] - v[0], ey = w[1] - v[1], ez = w[2] - v[2];
        // No fma here: the products must cancel alike in both triangles of an edge
        const VF px = (y * ez - z * ey) * side, py = (z * ex - x * ez) * side, pz = (x * ey - y * ex) * side;
        lines.a[k] = maskDot(px, py, pz, p->stepX.xyz);
        lines.b[k] = maskDot(px, py, pz, p->stepY.xyz);
        lines.c[k] = maskDot(px, py, pz, o->toCorner);
    }
    // Hidden samples lie beyond the plane, where the receiver does not: n.(sample - origin) > n.(corner 0 - origin)
    lines.a[3] = maskDot(nx, ny, nz, p->stepX.xyz) * side;
    lines.b[3] = maskDot(nx, ny, nz, p->stepY.xyz) * side;
    lines.c[3] = (maskDot(nx, ny, nz, o->toCorner) - above) * side;
    return lines;
}

/// Ends of rows as linear functions, column = slope x row + start, of the four lines. Where a line does not
/// bound that side, its end lies beyond all columns.
typedef struct {
    float a[4][LANES], b[4][LANES], c[4][LANES];
    float leftSlope[4][LANES], leftStart[4][LANES], rightSlope[4][LANES], rightStart[4][LANES];
} MaskEnds;

inline void maskEnds(const MaskLines* lines, MaskEnds* ends) {
#pragma unroll
    for (int k = 0; k < 4; ++k) {
        const VF a = lines->a[k], b = lines->b[k], c = lines->c[k];
        // A line along a row: its end is far to the left or to the right, by the side that the row lies on
        const VF least = fma(fabs(b), (VF)64.0f, fabs(c)) * 1e-18f + 1e-37f;
        const VI left = V_MASK(a >= 0.0f);
        const VF safe = V_SELECT(min(a, -least), max(a, least), left);
        const VF slope = -b / safe, start = -c / safe;
        V_STORE(V_SELECT((VF)0.0f, slope, left), ends->leftSlope[k], 0);
        V_STORE(V_SELECT((VF)-MASK_BEYOND, start, left), ends->leftStart[k], 0);
        V_STORE(V_SELECT(slope, (VF)0.0f, left), ends->rightSlope[k], 0);
        V_STORE(V_SELECT(start, (VF)MASK_BEYOND, left), ends->rightStart[k], 0);
        V_STORE(a, ends->a[k], 0);
        V_STORE(b, ends->b[k], 0);
        V_STORE(c, ends->c[k], 0);
    }
}

/// v >= 0 rounded up; ceil() is slow where a device has no instruction for it.
inline VI maskCeil(VF v) {
    const VI whole = V_TO_INT(v);
    return whole - V_MASK(V_TO_FLOAT(whole) < v);
}

/// Bits of columns in [left, right] of a word; left >= 0, right < 32.
inline VU maskBits(VF left, VF right) {
    const VI inside = V_MASK(left <= right);
    const VI start = V_SELECT((VI)0, maskCeil(left), inside), stop = V_SELECT((VI)0, V_TO_INT(right), inside);
    return ((VU)0xffffffffu << V_AS_UINT(start & 31)) & ((VU)0xffffffffu >> V_AS_UINT((31 - stop) & 31)) &
           V_AS_UINT(inside);
}

/// Rows first to last of one lane's triangle. planes: 3, or 4 with the triangle's own.
inline void maskRows(const Raster4dParams* p, const MaskEnds* e, int lane, int planes, int first, int last,
                     uint* mask) {
    for (int row = first; row <= last; row += LANES) {
        const VF i = V_TO_FLOAT(V_INDEX + row);
        VF left = (VF)0.0f, right = (VF)(float)(p->columns - 1);
#pragma unroll
        for (int k = 0; k < 3; ++k) {
            left = max(left, fma((VF)e->leftSlope[k][lane], i, (VF)e->leftStart[k][lane]));
            right = min(right, fma((VF)e->rightSlope[k][lane], i, (VF)e->rightStart[k][lane]));
        }
        if (planes > 3) {
            left = max(left, fma((VF)e->leftSlope[3][lane], i, (VF)e->leftStart[3][lane]));
            right = min(right, fma((VF)e->rightSlope[3][lane], i, (VF)e->rightStart[3][lane]));
        }
        right = V_SELECT((VF)-1.0f, right, V_MASK(i <= (float)last));
        V_STORE(V_LOAD(mask + row, 0) | maskBits(left, min(right, (VF)31.0f)), mask + row, 0);
        if (p->words == 1) continue;
        uint* rows = mask + MASK_STRIDE + row;
        V_STORE(V_LOAD(rows, 0) | maskBits(max(left - 32.0f, (VF)0.0f), right - 32.0f), rows, 0);
    }
}

/// The same bits one at a time: what [4DR] table 2 compares rows with.
inline void maskBitwise(const Raster4dParams* p, const MaskEnds* e, int lane, int planes, int first, int last,
                        uint* mask) {
    for (int row = first; row <= last; ++row)
        for (int column = 0; column < p->columns; ++column) {
            int inside = 1;
            for (int k = 0; k < planes; ++k)
                inside &= fma(e->leftSlope[k][lane], (float)row, e->leftStart[k][lane]) <= (float)column &&
                          (float)column <= fma(e->rightSlope[k][lane], (float)row, e->rightStart[k][lane]);
            mask[(column >> 5) * MASK_STRIDE + row] |= (uint)inside << (column & 31);
        }
}

/// One row of each lane's triangle, whose corners must all lie between light and receiver: most triangles of a fine
/// mesh reach no more. bits [word][lane]
inline void maskOneRow(const Raster4dParams* p, const MaskEnds* e, VF row, uint bits[2][LANES]) {
    VF left = (VF)0.0f, right = (VF)(float)(p->columns - 1);
#pragma unroll
    for (int k = 0; k < 3; ++k) {
        left = max(left, fma(V_LOAD(e->leftSlope[k], 0), row, V_LOAD(e->leftStart[k], 0)));
        right = min(right, fma(V_LOAD(e->rightSlope[k], 0), row, V_LOAD(e->rightStart[k], 0)));
    }
    V_STORE(maskBits(left, min(right, (VF)31.0f)), bits[0], 0);
    if (p->words > 1) V_STORE(maskBits(max(left - 32.0f, (VF)0.0f), right - 32.0f), bits[1], 0);
}

/// Columns of a row that a lane's triangle may hide where samples lie up to `slack` off their cells' centres.
inline float2 maskColumns(const Raster4dParams* p, const MaskEnds* e, int lane, int planes, float row, float slack) {
    float left = 0.0f, right = (float)(p->columns - 1);
    for (int k = 0; k < planes; ++k) {
        const float from = fma(e->leftSlope[k][lane], row, e->leftStart[k][lane]);
        const float to = fma(e->rightSlope[k][lane], row, e->rightStart[k][lane]);
        const float spread = slack * (1.0f + fabs(e->leftSlope[k][lane] + e->rightSlope[k][lane]));
        const float rounding = slack > 0.0f ? 1e-5f : 0.0f;
        left = max(left, from - spread - rounding * fabs(from));
        right = min(right, to + spread + rounding * fabs(to));
    }
    return (float2)(left, right);
}

#endif
