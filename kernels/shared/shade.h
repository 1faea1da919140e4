// SPDX-License-Identifier: MIT
#ifndef SHARED_SHADE_H
#define SHARED_SHADE_H
#include "shared/portable.h"
SHARED_BEGIN

#define SHADE_MAX_CORNERS 16
#define SHADE_POINTS 16

/// An area light as shading sees it, in its own frame (z along the emission).
typedef struct {
    Affine lightFromWorld;
    float4 radiance;      ///< RGB; of a light of size zero: intensity
    int corners;          ///< 4, SHADE_MAX_CORNERS for disks, 0: a point
    float area;           ///< square metres
    float cosInner, cosOuter;  ///< cone; cosOuter -2: none
    float halfWidth, halfHeight;  ///< metres
    int unused[2];
    float4 corner[SHADE_MAX_CORNERS / 2];  ///< (x, y) of two corners each, in order around the light
    float4 point[SHADE_POINTS / 2];        ///< (x, y) of two fixed points each, for reflections
} ShadeLight;
SHARED_STRUCT(ShadeLight, 352)

typedef struct {
    float4 eye;      ///< as in GBufferParams
    float4 ambient;  ///< RGB radiance that a white diffuse surface reflects everywhere
    int planeStride;
    int channels;    ///< of visibility: 1 or 3
    int unused[2];
} ShadeParams;
SHARED_STRUCT(ShadeParams, 48)

SHARED_END
#endif
