// SPDX-License-Identifier: MIT
#ifndef SHARED_RAYTRACE_H
#define SHARED_RAYTRACE_H
#include "shared/portable.h"
SHARED_BEGIN

typedef struct {
    Affine lightFromWorld;
    float halfWidth, halfHeight;  ///< metres, of the light
    int samples;                  ///< rays per pixel
    int channels;                 ///< of visibility: 3 if anything is blended, else 1
    uint onlyState;               ///< pixels of this state are traced (STATE_*)
    int classify;                 ///< 1: writes the pixels' states first; 0: keeps them
    int mean;                     ///< 1: one channel of visibility is the mean of three
    int unused;
} RaytraceParams;
SHARED_STRUCT(RaytraceParams, 80)

SHARED_END
#endif
