// SPDX-License-Identifier: MIT
// The rasteriser's view of the world, for cameras and lights alike.
#ifndef SHARED_RASTER_H
#define SHARED_RASTER_H
#include "shared/portable.h"
SHARED_BEGIN

#define RASTER_SUBPIXEL_BITS 8
#define RASTER_SMALL 16        // pixels: triangles up to this extent are done in one go
#define RASTER_TILE 32         // pixels: side of the tiles that larger triangles are cut into
#define RASTER_MAX_SIZE 16384  // pixels: with 8 sub-pixel bits, the guard band still fits 24 bits

/// pixel = (dot(rowX, p) / W, dot(rowY, p) / W), W = dot(rowW, p), depth = dot(rowD, p) / W with
/// p = (world position, 1). Depth is 1 at the near plane and falls with distance; what is nearer than
/// the near plane (depth > 1) is clipped. Pixel (0, 0) covers [0, 1) x [0, 1), row 0 is the top.
typedef struct {
    float4 rowX, rowY, rowW, rowD;
    int width, height;   ///< pixels
    int triangleCount;
    uint requireFlags;   ///< draws without all of these are skipped
    uint cullBack;       ///< back faces of draws with any of these flags are dropped
    uint cullFront;      ///< front faces of draws with any of these flags are dropped
    uint frontIsClockwise;  ///< 1: front faces turn clockwise on the screen
    uint tileCapacity;   ///< entries that the list of large triangles' tiles holds
    int conservative;    ///< 1: all pixels that a triangle touches, not those whose centre it holds
    uint keepBoth;       ///< both faces of draws with any of these flags are kept all the same
    int unused[2];
} RasterView;
SHARED_STRUCT(RasterView, 112)

/// A tile of a triangle that is too large to be done in one go.
typedef struct {
    uint triangle;
    uint tile;  ///< bits 0-17: row * 512 + column, in tiles; bits 28-31: part of a clipped triangle
} RasterTile;
SHARED_STRUCT(RasterTile, 8)

SHARED_END
#endif
