// SPDX-License-Identifier: MIT
// The A-buffer: lists of the blended fragments that a pixel sees before its opaque surface, all in one array.
//   ends       [pixel]        where a pixel's list ends; it starts where the list of the pixel before ends
//   fragments  [fragment, 2]  depth bits, triangle; nearest first within a list
//   owners     [fragment]     pixel
//   coverage   [4, fragment]  see COVERAGE_*
// A fragment is a pixel of the G-buffer: fragment f stands behind the image's pixels, at pixels + f.
#ifndef SHARED_ABUFFER_H
#define SHARED_ABUFFER_H
#include "shared/portable.h"
SHARED_BEGIN

#define COVERAGE_ALPHA 0    // weight of the fragment's own colour
#define COVERAGE_THROUGH 1  // 3: share of what lies behind that passes, RGB
#define COVERAGE_PLANES 4

typedef struct {
    int pixels;       ///< of the image
    int planeStride;  ///< floats between planes of G-buffer and colour
    int depthStride;  ///< words between pixels of the opaque depths; a depth is the last of its pixel's
    uint capacity;    ///< fragments that the array holds
} ABufferParams;
SHARED_STRUCT(ABufferParams, 16)

SHARED_END
#endif
