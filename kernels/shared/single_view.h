// SPDX-License-Identifier: MIT
// What the techniques with one map from the light's centre are launched with.
#ifndef SHARED_SINGLE_VIEW_H
#define SHARED_SINGLE_VIEW_H
#include "shared/portable.h"
SHARED_BEGIN

#define PCSS_ROTATIONS 256  // of the sample pattern, by pixel in tiles of 16 x 16

typedef struct {
    int blockerTaps, filterTaps;
    float reachX, reachY;   ///< kx, ky of the rim of the disk (rectangle: of the same area)
    float leastSpread;      ///< of the filter, in units of w
    int receiverWidth;      ///< receivers in a row
    int planeBias;          ///< 1: taps compare with the receiver's plane, 0: with its depth
    int unused;
} PcssParams;
SHARED_STRUCT(PcssParams, 32)

#define ESSM_MAX_LEVELS 14

typedef struct {
    float exponent;
    float nearZ, inverseRange;  ///< warped depth = (z - nearZ) * inverseRange, clamped to [0, 1]
    float leak;                 ///< visibility below it becomes 0
    float reachX, reachY;       ///< kx, ky of the rim of the light's square of equal area
    float leastRadius;          ///< of a filter, texels
    int levels;
    int firstTexel[ESSM_MAX_LEVELS];  ///< of each level in a plane of the pyramid
    int size[ESSM_MAX_LEVELS];
    int texels;                 ///< of all levels: floats between planes
    int unused[3];
} EssmParams;
SHARED_STRUCT(EssmParams, 160)

SHARED_END
#endif
