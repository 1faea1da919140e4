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
#define TEMPORAL_SAME 0.01f  // of its depth: what is nearer is the same surface

/// Pixel of the last frame that a point of this frame's was seen at, or -1; `depth`: its depth there.
inline int lastPixel(const TemporalParams* t, global const float* restrict planes, int entry, float* depth) {
    const int stride = t->planeStride;
    const float x = planes[GB_PREVIOUS * stride + entry], y = planes[(GB_PREVIOUS + 1) * stride + entry],
                z = planes[(GB_PREVIOUS + 2) * stride + entry];
    const float w = dotPoint(t->rowW, x, y, z);
    if (w <= 0.0f) return -1;
    const float column = dotPoint(t->rowX, x, y, z) / w, row = dotPoint(t->rowY, x, y, z) / w;
    if (!(column >= 0.0f && column < (float)t->width && row >= 0.0f && row < (float)t->height)) return -1;
    *depth = dotPoint(t->rowDepth, x, y, z);
    return (int)row * t->width + (int)column;
}

/// Entry of the last frame that was this entry's surface, or -1: of a pixel the pixel there, of a blended
/// fragment the one of those there whose depth is nearest.
inline int previousEntry(const TemporalParams* t, global const float* restrict planes,
                         global const uint* restrict lastEnds, global const float* restrict lastDepth,
                         global const uint* restrict lastObject, int entry) {
    const int pixels = t->width * t->height;
    float depth;
    const int pixel = lastPixel(t, planes, entry, &depth);
    if (pixel < 0) return -1;
    const uint object = as_uint(planes[GB_OBJECT * t->planeStride + entry]);
    const int blended = entry >= pixels;
    const int begin = !blended ? pixel : pixels + (pixel ? (int)lastEnds[pixel - 1] : 0);
    const int end = !blended ? pixel + 1 : pixels + (int)lastEnds[pixel];
    int best = -1;
    float least = TEMPORAL_SAME * fabs(depth);
    for (int last = begin; last < end; ++last) {
        const float off = fabs(lastDepth[last] - depth);
        if (lastObject[last] != object || !(off < least)) continue;
        best = last;
        least = off;
    }
    return best;
}

/// One work-item per entry: the frame's own visibility becomes age 0 of its history, NONE where nothing was tested.
kernel void temporal_begin(const TemporalParams params, global const uint* restrict state,
                           global const float* restrict visibility, global float* restrict newHistory) {
    const int entry = get_global_id(0), stride = params.planeStride;
    if (entry >= stride) return;
    for (int channel = 0; channel < params.channels; ++channel)
        newHistory[channel * stride + entry] =
            state[entry] == STATE_TESTED ? visibility[channel * stride + entry] : TEMPORAL_NONE;
}

/// Least and largest visibility of this frame over what was tested among 3 x 3 pixels: what lies outside is a
/// ghost. Around a blended fragment, the fragments of the same surface.
inline float2 neighbourhood(const TemporalParams* t, global const float* restrict planes,
                            global const uint* restrict ends, global const uint* restrict owners,
                            global const float* now, int entry) {
    const int pixels = t->width * t->height, blended = entry >= pixels, stride = t->planeStride;
    const int pixel = blended ? (int)owners[entry - pixels] : entry;
    const int x = pixel % t->width, y = pixel / t->width;
    const float depth = planes[GB_DEPTH * stride + entry], object = planes[GB_OBJECT * stride + entry];
    float2 range = (float2)(now[entry], now[entry]);
    for (int row = max(y - 1, 0); row <= min(y + 1, t->height - 1); ++row)
        for (int column = max(x - 1, 0); column <= min(x + 1, t->width - 1); ++column) {
            const int at = row * t->width + column;
            const int begin = !blended ? at : pixels + (at ? (int)ends[at - 1] : 0);
            const int end = !blended ? at + 1 : pixels + (int)ends[at];
            for (int other = begin; other < end; ++other) {
                const int same = !blended || (as_uint(planes[GB_OBJECT * stride + other]) == as_uint(object) &&
                                              fabs(planes[GB_DEPTH * stride + other] - depth) <
                                                  TEMPORAL_SAME * fabs(depth));
                const float value = now[other];
                if (!same || value < 0.0f) continue;
                range.x = min(range.x, value);
                range.y = max(range.y, value);
            }
        }
    return range;
}

/// One work-item per entry of the G-buffer. history [age, channel, stride]: oldHistory of the last frame, newHistory
/// of this one, whose age 0 temporal_begin wrote. visibility [channel, stride] becomes the mean; history is kept as
/// it was and clamped to the neighbourhood only there, so that a mean depends on nothing but the frames of its window.
/// ends, owners, lastEnds: lists of blended fragments of this and the last frame; not read where there are none.
kernel void temporal(const TemporalParams params, global const float* restrict planes,
                     global const uint* restrict ends, global const uint* restrict owners,
                     global const uint* restrict lastEnds, global const float* restrict lastDepth,
                     global const uint* restrict lastObject, global const uint* restrict state,
                     global const float* restrict oldHistory, global float* newHistory,
                     global float* restrict visibility) {
    const int entry = get_global_id(0), stride = params.planeStride;
    if (entry >= stride) return;
    const int tested = state[entry] == STATE_TESTED;
    const int last = tested && params.valid > 0
                         ? previousEntry(&params, planes, lastEnds, lastDepth, lastObject, entry)
                         : -1;
    for (int channel = 0; channel < params.channels; ++channel) {
        float sum = visibility[channel * stride + entry];
        int count = 1;
        const float2 range =
            last >= 0 ? neighbourhood(&params, planes, ends, owners, newHistory + channel * stride, entry)
                      : (float2)(0.0f);
        for (int age = 0; age < params.ages; ++age) {
            const float value = last >= 0 && age < params.valid
                                    ? oldHistory[(age * params.channels + channel) * params.lastStride + last]
                                    : TEMPORAL_NONE;
            if (age + 1 < params.ages)
                newHistory[((age + 1) * params.channels + channel) * stride + entry] = value;
            if (value < 0.0f) continue;
            sum += clamp(value, range.x, range.y);
            ++count;
        }
        if (tested) visibility[channel * stride + entry] = sum / (float)count;
    }
}

/// Keeps what the next frame compares with. One work-item per entry.
kernel void temporal_keep(const int stride, global const float* restrict planes,
                          global float* restrict lastDepth, global uint* restrict lastObject) {
    const int entry = get_global_id(0);
    if (entry >= stride) return;
    lastDepth[entry] = planes[GB_DEPTH * stride + entry];
    lastObject[entry] = as_uint(planes[GB_OBJECT * stride + entry]);
}
