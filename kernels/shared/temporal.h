// SPDX-License-Identifier: MIT
#ifndef SHARED_TEMPORAL_H
#define SHARED_TEMPORAL_H
#include "shared/portable.h"
SHARED_BEGIN

typedef struct {
    float4 rowX, rowY, rowW;  ///< the last frame's camera: pixel = (rowX, rowY).(p, 1) / rowW.(p, 1)
    float4 rowDepth;          ///< its camera depth
    int width, height;        ///< of the image
    int planeStride;          ///< of this frame's G-buffer, visibility and history
    int lastStride;           ///< of the last frame's history
    int ages;                 ///< frames of history, at most
    int channels;             ///< of visibility
    int valid;                ///< frames of history that hold something
    int unused;
} TemporalParams;
SHARED_STRUCT(TemporalParams, 96)

SHARED_END
#endif
