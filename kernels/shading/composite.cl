// SPDX-License-Identifier: MIT
// Puts the shaded fragments of a pixel over its opaque surface, from the nearest to the farthest.
//   colour of pixels and fragments, coverage --lists--> colour, alpha, which entry a pixel's other channels show
// Source: Porter and Duff 1984 (over), with a filter for each colour: KHR_materials_transmission.
#include "lib/transform.h"
#include "shared/abuffer.h"
#include "shared/gbuffer.h"

#define COMPOSITE_FRONT_ALPHA 0.5f  // what is more transparent is not what depth and ids show

/// One work-item per pixel of the image.
/// colour  [3, planeStride]  of pixels and fragments; those of the image become the composite
/// alpha   [pixel]  share of a pixel that is covered; the mean over the colours where they are filtered
/// front   [pixel]  entry of the G-buffer of the first surface of an alpha above 0.5
kernel void composite(const ABufferParams params, global const uint* restrict ends,
                      global const float* restrict coverage, global const float* restrict planes,
                      global float* colour, global float* restrict alpha, global uint* restrict front) {
    const int pixel = get_global_id(0), stride = params.planeStride;
    if (pixel >= params.pixels) return;
    const uint begin = pixel ? ends[pixel - 1] : 0, end = min(ends[pixel], params.capacity);
    float sum[3] = {0.0f, 0.0f, 0.0f}, through[3] = {1.0f, 1.0f, 1.0f};
    uint first = (uint)pixel;
    for (uint f = begin; f < end; ++f) {
        const float a = coverage[COVERAGE_ALPHA * params.capacity + f];
        const int entry = params.pixels + (int)f;
        if (a > COMPOSITE_FRONT_ALPHA && first == (uint)pixel) first = (uint)entry;
        for (int c = 0; c < 3; ++c) {
            const float weight = through[c] * a;
            sum[c] = fma(weight, colour[c * stride + entry], sum[c]);
            through[c] *= coverage[(COVERAGE_THROUGH + c) * params.capacity + f];
        }
    }
    const int covered = as_uint(planes[GB_OBJECT * stride + pixel]) != 0;
    for (int c = 0; c < 3; ++c) colour[c * stride + pixel] = fma(through[c], colour[c * stride + pixel], sum[c]);
    alpha[pixel] = covered ? 1.0f : 1.0f - (through[0] + through[1] + through[2]) / 3.0f;
    front[pixel] = first;
}
