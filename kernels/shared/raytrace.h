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
    int shape;                    ///< of random samples: RAY_SAMPLES_*
    float4 centre;                ///< of the light, re-based world; w: seed of random samples, as uint bits
    float4 axisX, axisY;          ///< half sides of the light, metres
} RaytraceParams;
SHARED_STRUCT(RaytraceParams, 128)

#define RAY_SAMPLES_FIXED 0      // the light's own, the same for all pixels
#define RAY_SAMPLES_RECTANGLE 1  // random in each pixel
#define RAY_SAMPLES_DISK 2

SHARED_END
#endif
