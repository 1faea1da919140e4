// SPDX-License-Identifier: MIT
// Averages visibility over a window of frames, following surfaces through their motion.
//   history of the last frame --where each pixel's surface was--> history of this frame --mean--> visibility
// Source: [VWSS] 5 names temporal averaging as future work (Scherzer et al. 2009); the fixed window, which
// makes a frame independent of all but the K - 1 before it, is ours. History is clamped to the frame's neighbourhood
// against ghosts (Karis, High Quality Temporal Supersampling, 2014).
#include "lib/transform.h"
#include "shared/gbuffer.h"
#include "shared/multi_view.h"
#include "shared/temporal.h"

#define TEMPORAL_NONE -1.0f

/// Pixel of the last frame that saw this pixel's surface, or -1.
inline int previousPixel(const TemporalParams* t, global const float* restrict planes,
                         global const float* restrict lastDepth, global const uint* restrict lastObject,
                         int pixel) {
    const int stride = t->planeStride;
    const float x = planes[GB_PREVIOUS * stride + pixel], y = planes[(GB_PREVIOUS + 1) * stride + pixel],
                z = planes[(GB_PREVIOUS + 2) * stride + pixel];
    const float w = dotPoint(t->rowW, x, y, z);
    if (w <= 0.0f) return -1;
    const float column = dotPoint(t->rowX, x, y, z) / w, row = dotPoint(t->rowY, x, y, z) / w;
    if (!(column >= 0.0f && column < (float)t->width && row >= 0.0f && row < (float)t->height)) return -1;
    const int last = (int)row * t->width + (int)column;
    const float depth = dotPoint(t->rowDepth, x, y, z);
    const int same = lastObject[last] == as_uint(planes[GB_OBJECT * stride + pixel]) &&
                     fabs(lastDepth[last] - depth) < 0.01f * fabs(depth);
    return same ? last : -1;
}

/// One work-item per pixel: the frame's own visibility becomes age 0 of its history, NONE where nothing was tested.
kernel void temporal_begin(const TemporalParams params, global const uint* restrict state,
                           global const float* restrict visibility, global float* restrict newHistory) {
    const int pixel = get_global_id(0), stride = params.planeStride;
    if (pixel >= stride) return;
    for (int channel = 0; channel < params.channels; ++channel)
        newHistory[channel * stride + pixel] =
            state[pixel] == STATE_TESTED ? visibility[channel * stride + pixel] : TEMPORAL_NONE;
}

/// Least and largest visibility of this frame over the pixels tested among 3 x 3: what lies outside is a ghost.
inline float2 neighbourhood(const TemporalParams* t, global const float* now, int pixel) {
    const int x = pixel % t->width, y = pixel / t->width;
    float2 range = (float2)(now[pixel], now[pixel]);
    for (int row = max(y - 1, 0); row <= min(y + 1, t->height - 1); ++row)
        for (int column = max(x - 1, 0); column <= min(x + 1, t->width - 1); ++column) {
            const float value = now[row * t->width + column];
            if (value < 0.0f) continue;
            range.x = min(range.x, value);
            range.y = max(range.y, value);
        }
    return range;
}

/// One work-item per pixel. history [age, channel, stride]: oldHistory of the last frame, newHistory of this
/// one, whose age 0 temporal_begin wrote. visibility [channel, stride] becomes the mean; history is kept as it was and
/// clamped to the neighbourhood only there, so that a mean depends on nothing but the frames of its window.
kernel void temporal(const TemporalParams params, global const float* restrict planes,
                     global const float* restrict lastDepth, global const uint* restrict lastObject,
                     global const uint* restrict state, global const float* restrict oldHistory,
                     global float* newHistory, global float* restrict visibility) {
    const int pixel = get_global_id(0), stride = params.planeStride;
    if (pixel >= stride) return;
    const int tested = state[pixel] == STATE_TESTED;
    const int last = tested && params.valid > 0
                         ? previousPixel(&params, planes, lastDepth, lastObject, pixel)
                         : -1;
    for (int channel = 0; channel < params.channels; ++channel) {
        const float now = visibility[channel * stride + pixel];
        float sum = now;
        int count = 1;
        const float2 range = last >= 0 ? neighbourhood(&params, newHistory + channel * stride, pixel) : (float2)(0.0f);
        for (int age = 0; age < params.ages; ++age) {
            const float value = last >= 0 && age < params.valid
                                    ? oldHistory[(age * params.channels + channel) * stride + last]
                                    : TEMPORAL_NONE;
            if (age + 1 < params.ages)
                newHistory[((age + 1) * params.channels + channel) * stride + pixel] = value;
            if (value < 0.0f) continue;
            sum += clamp(value, range.x, range.y);
            ++count;
        }
        if (tested) visibility[channel * stride + pixel] = sum / (float)count;
    }
}

/// Keeps what the next frame compares with.
kernel void temporal_keep(const int stride, global const float* restrict planes,
                          global float* restrict lastDepth, global uint* restrict lastObject) {
    const int pixel = get_global_id(0);
    if (pixel >= stride) return;
    lastDepth[pixel] = planes[GB_DEPTH * stride + pixel];
    lastObject[pixel] = as_uint(planes[GB_OBJECT * stride + pixel]);
}
