// SPDX-License-Identifier: MIT
// Exact occlusion masks by generalised projection [4DR]. Everything is in the light's grid: light sample
// (row i, column j) lies at x = j, y = i, z = 0, and z grows along the light's emission, in units of the
// larger side of a cell.
//
// A receiver q sees the samples at slopes (q.x - j) / q.z. A triangle can hide a sample only if the box of
// its own slopes, for all samples and corners, holds all of the receiver's ([4DR] 3.2, with the plane P at
// infinity), and if a corner is nearer to the light than the receiver. Five numbers say so:
//   receiver  q.x / q.z,  -(q.x - last column) / q.z,  the same for y,  -q.z   (samples off their cells' centres
//             widen the columns and rows by half a cell at both ends)
//   triangle  the largest of those of its corners
// and the pair counts where none of the receiver's is above the triangle's. Boxes of receivers keep the least,
// boxes of triangles the largest, so that culling a box never loses a pair, to the bit.
// Slopes of triangles are widened by what rounding may take from those of their corners.
//
//   receivers       float [R4_RECEIVER_PLANES, stride]  sorted; see below
//   bounds          float [node, R4_BOUNDS, R4_WIDTH]    of 16 triangles, of 16 such nodes, ..
//   corners         float [node, R4_CORNERS, R4_WIDTH]   of the triangles of the lowest nodes, grid
//   world           float [triangle, R4_WORLD]           sorted; the same and the normal, re-based world
//   order           uint [triangle]                      index into the mesh; R4_SURFACE: its opacity varies
//   masks           uint [rows * words, pixel]           bit j of row i: sample (i, j) is hidden
#ifndef SHARED_RASTER4D_H
#define SHARED_RASTER4D_H
#include "shared/portable.h"
SHARED_BEGIN

#define R4_ROWS 64      // at most; columns too
#define R4_WIDTH 16     // children of a node, receivers of a group
#define R4_BOUNDS 5
#define R4_LEVELS 3     // of nodes: triangles, clusters, clusters of clusters
#define R4_SURFACE 0x80000000u
#define R4_KEY_BITS 8   // of each axis of a sorting key
#define R4_KEY_NONE 0xffffffffu

// Planes of receivers
#define R4_Q 0          // 3: grid
#define R4_BOUND 3      // 5: what is compared with bounds
#define R4_PIXEL 8      // uint bits
#define R4_ORIGIN 9     // 3: re-based world
#define R4_RECEIVER_PLANES 12

#define R4_CORNERS 9    // x, y, z of corner 0, then of 1 and 2
#define R4_WORLD 12     // the same, then the normal

typedef struct {
    Affine gridHigh, gridLow;  ///< grid <- re-based world: sums of two floats
    Affine lightFromWorld;
    float4 corner, cornerLow;    ///< light sample (0, 0), re-based world: a sum of two floats
    float4 stepX, stepY;         ///< from column to column and row to row, metres
    float4 keyCentre;     ///< of slopes x, y and z that sorting spreads about
    float4 keyScale;
    float halfWidth, halfHeight;  ///< of the light, metres
    int columns, rows, words;     ///< words of 32 bits in a row
    int centred;          ///< 1: all samples lie at the centres of their cells
    int samples;
    int sampleStride;     ///< step of the opacity shuffle
    int triangleCount;    ///< of the mesh
    int casterCount;
    int nodeCount[R4_LEVELS];  ///< nodes of each level
    int keepMasks;
    int planeStride;      ///< pixels between planes of visibility and masks
    int receiverStride;   ///< floats between planes of receivers
    int tileGroups;       ///< groups of receivers that a work-item takes
    int rowAtOnce;        ///< 0: bits one at a time
    float slack;          ///< cells that samples may lie off their cells' centres: 0 or 0.5
    int unused;
} Raster4dParams;
SHARED_STRUCT(Raster4dParams, 320)

/// The paper's grid, a band of its rows.
typedef struct {
    int size;                ///< pixels on a side
    int firstRow, rowCount;  ///< of the band
    int onePixel;            ///< 1: a receiver is assigned to one pixel
    int reject;              ///< 1: pairs without full coverage are left out before their rows
    int fill;                ///< 0: count, 1: write
    uint capacity;           ///< entries of a list
    int unused;
} Raster4dGridParams;
SHARED_STRUCT(Raster4dGridParams, 32)

SHARED_END
#endif
