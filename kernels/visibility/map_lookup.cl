// SPDX-License-Identifier: MIT
// Averages the shadow tests of all depth maps at each pixel.
//   G-buffer --shadow origin, light's frame--> receivers --tests per view--> hidden counts --> visibility
// Source: [VWSS] 2.1 (visibility factor), 4 (5 taps a map); receiver-plane bias is our own:
// the receiver's depth is affine over a map (1/z of a plane), so each tap is compared with the plane's depth
// at that texel's centre, and what a stored point may lie off the centre (half a texel) is the slope bias.
// Counts are integers: the order and the batches of views do not change the result.
#include "lib/lanes.h"
#include "lib/receiver.h"

/// Index of the receiver of a pixel, or -1 where the pixel is not tested itself. The receivers of blended
/// fragments follow those of the image.
inline int receiverOf(const ReceiverParams* image, int pixel) {
    if (image->pixelStep == 1) return pixel;
    const int x = pixel % image->width, y = pixel / image->width, rows = image->height - image->fragmentRows;
    if (y >= image->height) return -1;
    if (y >= rows) return ((rows + 1) >> 1) * image->receiverWidth + pixel - rows * image->width;
    return !(x & 1) && !(y & 1) ? (y >> 1) * image->receiverWidth + (x >> 1) : -1;
}

/// One work-item per pixel, padding included. Fills receivers [RECEIVER_PLANES, receiverStride], state
/// [stride] and clears hidden [receiverStride]; the host clears receivers where pixelStep is 2.
kernel void receivers(const ReceiverParams image, const MultiViewParams params,
                      global const float* restrict planes, global float* restrict receiver,
                      global uint* restrict state, global uint* restrict hidden,
                      volatile global MultiViewCounters* counters) {
    const int pixel = get_global_id(0), stride = image.planeStride;
    if (pixel >= stride) return;
    const int slot = receiverOf(&image, pixel), slots = image.receiverStride;
    if (slot >= 0) {
        hidden[slot] = 0;
        receiver[RECEIVER_W * slots + slot] = 0.0f;
    }
    const Receiver r = receiverAt(&image, &params.lightFromWorld, params.halfWidth, params.halfHeight, planes, pixel);
    state[pixel] = r.state;
    if (r.state != STATE_TESTED) return;
    const float w = params.near / r.z, a = fma(params.focal, r.x / r.z, params.centre),
                b = fma(params.focal, r.y / r.z, params.centre);
    const float reachX = params.halfWidth * params.focal / params.near * w;
    const float reachY = params.halfHeight * params.focal / params.near * w;
    const float size = (float)params.resolution;
    if (a - reachX < 0.0f || a + reachX >= size || b - reachY < 0.0f || b + reachY >= size) {
        if (image.countOutside) atomic_inc(&counters->outsideFov);
        state[pixel] = image.outsideState;
        if (image.outsideState != STATE_TESTED) return;
    }
    if (slot >= 0) {
        receiver[RECEIVER_A * slots + slot] = a;
        receiver[RECEIVER_B * slots + slot] = b;
        receiver[RECEIVER_W * slots + slot] = w;
        receiver[RECEIVER_GRADIENT_X * slots + slot] = params.near * r.nx / params.focal;
        receiver[RECEIVER_GRADIENT_Y * slots + slot] = params.near * r.ny / params.focal;
        receiver[RECEIVER_FACING * slots + slot] = r.facing;
    }
}

/// Packs 16-bit depths from the 32-bit texels that atomics need. One work-item per texel of all maps.
kernel void map_pack(const uint count, global const uint* restrict wide, global ushort* restrict maps) {
    const uint texel = get_global_id(0);
    if (texel < count) maps[texel] = (ushort)wide[texel];
}

// Sets `tests` to the weights of the taps that hide, by HIDES(dx, dy)
#define LOOKUP_TAPS                                                                                      \
    if (bilinear) {                                                                                      \
        const VI fx = V_TO_INT((u - column0) * 16.0f), fy = V_TO_INT((v - row0) * 16.0f);                \
        tests = (HIDES(0, 0) & ((16 - fx) * (16 - fy))) + (HIDES(1, 0) & (fx * (16 - fy))) +             \
                (HIDES(0, 1) & ((16 - fx) * fy)) + (HIDES(1, 1) & (fx * fy));                            \
    } else {                                                                                             \
        tests = -HIDES(0, 0);                                                                            \
        if (lookup.pcf >= 5) tests -= HIDES(-1, 0) + HIDES(1, 0) + HIDES(0, -1) + HIDES(0, 1);           \
        if (lookup.pcf >= 9) tests -= HIDES(-1, -1) + HIDES(1, -1) + HIDES(-1, 1) + HIDES(1, 1);         \
    }
#define LOOKUP_KERNEL map_lookup
#define LOOKUP_TEXEL uint
#define LOOKUP_DEPTH(bits) V_AS_FLOAT(bits)
#include "visibility/map_lookup.inl"
#define LOOKUP_KERNEL map_lookup16
#define LOOKUP_TEXEL ushort
#define LOOKUP_DEPTH(bits) (V_TO_FLOAT(bits) * (1.0f / 65535.0f))
#include "visibility/map_lookup.inl"

/// visibility [channels, stride]: share of the tests passed, 1 where nothing was to be tested. One work-item per
/// pixel and channel; hidden [channels, stride]; weight: sum of the weights of one view's tests.
kernel void map_average(const int stride, const int views, const int weight,
                        global const uint* restrict state, global const uint* restrict hidden,
                        global float* restrict visibility) {
    const int pixel = get_global_id(0), plane = (int)get_global_id(1) * stride;
    if (pixel >= stride) return;
    const float total = (float)views * (float)weight;
    visibility[plane + pixel] =
        state[pixel] == STATE_TESTED ? (total - (float)hidden[plane + pixel]) / total : 1.0f;
}

/// Weight of a neighbour's result: full on the same plane, none across edges or folds.
inline float similarity(global const float* restrict planes, int stride, int pixel, int other) {
    float along = 0.0f, apart = 0.0f, squared = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
        const float n = planes[(GB_GEOMETRIC + axis) * stride + pixel];
        const float d = planes[(GB_POSITION + axis) * stride + other] - planes[(GB_POSITION + axis) * stride + pixel];
        along += n * planes[(GB_GEOMETRIC + axis) * stride + other];
        apart += n * d;
        squared += d * d;
    }
    const float slope = apart * apart / max(squared, 1e-20f);
    return max(along - 0.8f, 0.0f) * max(1.0f - 16.0f * slope, 0.0f);
}

/// As map_average with receivers at every other pixel: the tested pixels around, weighted by distance and
/// by how much they lie on the same surface; where none does, the nearest tested one.
kernel void map_upsample(const ReceiverParams image, const int views, const int weight,
                         global const float* restrict planes, global const uint* restrict state,
                         global const uint* restrict allHidden, global float* restrict allVisibility) {
    const int pixel = get_global_id(0), channel = get_global_id(1), stride = image.planeStride;
    if (pixel >= stride) return;
    global const uint* hidden = allHidden + channel * image.receiverStride;
    global float* visibility = allVisibility + channel * stride;
    visibility[pixel] = 1.0f;
    if (state[pixel] != STATE_TESTED) return;
    const int x = pixel % image.width, y = pixel / image.width, rows = image.height - image.fragmentRows;
    const float total = (float)views * (float)weight;
    if (y >= rows) {
        visibility[pixel] = (total - (float)hidden[receiverOf(&image, pixel)]) / total;
        return;
    }
    float sum = 0.0f, weights = 0.0f, nearest = 1.0f, nearestWeight = 0.0f;
    for (int i = 0; i < 9; ++i) {
        // Even pixels within two columns and rows
        const int ex = (x & ~1) + 2 * (i % 3 - 1), ey = (y & ~1) + 2 * (i / 3 - 1);
        if (ex < 0 || ey < 0 || ex >= image.width || ey >= rows) continue;
        const float wx = 2.0f - (float)abs(ex - x), wy = 2.0f - (float)abs(ey - y);
        const int other = ey * image.width + ex;
        if (wx <= 0.0f || wy <= 0.0f || state[other] != STATE_TESTED) continue;
        const float value = (total - (float)hidden[(ey >> 1) * image.receiverWidth + (ex >> 1)]) / total;
        const float w = wx * wy * similarity(planes, stride, pixel, other);
        sum += w * value;
        weights += w;
        if (wx * wy > nearestWeight) {
            nearestWeight = wx * wy;
            nearest = value;
        }
    }
    visibility[pixel] = weights > 1e-6f ? sum / weights : nearest;
}
