// SPDX-License-Identifier: MIT
// Triangles rasterised into the depth maps of a light's views.
#ifndef SHARED_MAP_RASTER_H
#define SHARED_MAP_RASTER_H
#include "shared/portable.h"
SHARED_BEGIN

// What is nearer than the near plane / MAP_NEAR_CLIP is cut off; between the two, depth is 1
#define MAP_NEAR_CLIP 16.0f

// Planes of the triangles that the views share: float [MAP_TRIANGLE_PLANES, capacity], corners in the
// central view as (a, b, w) of shared/multi_view.h
#define MAP_TRIANGLE_PLANES 9

// Flags of such a triangle
#define MAP_DROP_COUNTERCLOCKWISE 1u
#define MAP_DROP_CLOCKWISE 2u

/// One launch: a view, or (mapraster_owned) a batch of views.
typedef struct {
    float kx, ky;         ///< of the view; in texels per unit of w
    float shiftX, shiftY; ///< of the vertices' planes towards the view: kx, ky, or 0 where they are the view's
    int view;             ///< of the light
    int firstView;        ///< that map 0 of the buffer belongs to
    int viewCount;        ///< of the batch
    int vertexStride;     ///< floats between planes of vertices
    int vertexCount;
    int capacity;         ///< triangles that the shared lists hold
    int conservative;     ///< 1: all texels that a triangle touches [VWSS] figure 6c
    float biasConstant;   ///< of written depths, pushing them away from the light
    float biasSlope;      ///< times the larger of the depth's steps per texel
    int unused[3];
} MapRasterParams;
SHARED_STRUCT(MapRasterParams, 64)

/// Lengths of the lists that mapraster_share fills.
typedef struct {
    uint plain;    ///< small and opaque
    uint special;  ///< large, masked, blended, or crossing the near plane
    uint unused[2];
} MapRasterCounts;
SHARED_STRUCT(MapRasterCounts, 16)

SHARED_END
#endif
