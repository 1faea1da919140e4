// SPDX-License-Identifier: MIT
// Averages the shadow tests of all depth maps at each pixel.
//   G-buffer --shadow origin, light's frame--> receivers --tests per view--> hidden counts --> visibility
// Source: [VWSS] 2.1 (visibility factor), 4 (5 taps a map); receiver-plane bias is our own:
// the receiver's depth is affine over a map (1/z of a plane), so each tap is compared with the plane's depth
// at that texel's centre, and what a stored point may lie off the centre (half a texel) is the slope bias.
// Counts are integers: the order and the batches of views do not change the result.
#include "lib/lanes.h"
#include "lib/shadow_origin.h"
#include "lib/transform.h"
#include "shared/gbuffer.h"
#include "shared/mesh.h"
#include "shared/multi_view.h"

/// One work-item per pixel, padding included. Fills receivers [RECEIVER_PLANES, stride], state [stride]
/// and clears hidden [stride].
kernel void receivers(const ReceiverParams image, const MultiViewParams params,
                      global const float* restrict planes, global float* restrict receiver,
                      global uint* restrict state, global uint* restrict hidden,
                      volatile global MultiViewCounters* counters) {
    const int pixel = get_global_id(0), stride = image.planeStride;
    if (pixel >= stride) return;
    hidden[pixel] = 0;
    state[pixel] = STATE_MASKED;
    receiver[RECEIVER_W * stride + pixel] = 0.0f;
    if (as_uint(planes[GB_OBJECT * stride + pixel]) == 0) return;
    const float3 position = (float3)(planes[GB_POSITION * stride + pixel],
                                     planes[(GB_POSITION + 1) * stride + pixel],
                                     planes[(GB_POSITION + 2) * stride + pixel]);
    const float3 normal = (float3)(planes[GB_GEOMETRIC * stride + pixel],
                                   planes[(GB_GEOMETRIC + 1) * stride + pixel],
                                   planes[(GB_GEOMETRIC + 2) * stride + pixel]);
    const float3 origin = shadowOrigin(position, normal, image.originOffset, image.worldMagnitude);
    const Affine m = params.lightFromWorld;
    const float x = dotPoint(m.row[0], origin.x, origin.y, origin.z);
    const float y = dotPoint(m.row[1], origin.x, origin.y, origin.z);
    const float z = dotPoint(m.row[2], origin.x, origin.y, origin.z);
    const float nx = dotVector(m.row[0], normal.x, normal.y, normal.z);
    const float ny = dotVector(m.row[1], normal.x, normal.y, normal.z);
    const float nz = dotVector(m.row[2], normal.x, normal.y, normal.z);
    const float facing = -(nx * x + ny * y + nz * z);
    // Behind the light, or below the horizon of every point of it
    if (z <= 0.0f || facing + fabs(nx) * params.halfWidth + fabs(ny) * params.halfHeight <= 0.0f) return;
    state[pixel] = STATE_LIT;
    if (!(as_uint(planes[GB_FLAGS * stride + pixel]) & DRAW_RECEIVES)) return;
    const float w = params.near / z, a = fma(params.focal, x / z, params.centre),
                b = fma(params.focal, y / z, params.centre);
    state[pixel] = STATE_TESTED;
    receiver[RECEIVER_A * stride + pixel] = a;
    receiver[RECEIVER_B * stride + pixel] = b;
    receiver[RECEIVER_W * stride + pixel] = w;
    receiver[RECEIVER_GRADIENT_X * stride + pixel] = params.near * nx / params.focal;
    receiver[RECEIVER_GRADIENT_Y * stride + pixel] = params.near * ny / params.focal;
    receiver[RECEIVER_FACING * stride + pixel] = facing;
    const float reachX = params.halfWidth * params.focal / params.near * w;
    const float reachY = params.halfHeight * params.focal / params.near * w;
    const float size = (float)params.resolution;
    if (a - reachX < 0.0f || a + reachX >= size || b - reachY < 0.0f || b + reachY >= size)
        atomic_inc(&counters->outsideFov);
}

#define LOOKUP_KERNEL map_lookup
#define LOOKUP_TEXEL uint
#define LOOKUP_DEPTH(bits) V_AS_FLOAT(bits)
#include "visibility/map_lookup.inl"
#define LOOKUP_KERNEL map_lookup16
#define LOOKUP_TEXEL ushort
#define LOOKUP_DEPTH(bits) (V_TO_FLOAT(bits) * (1.0f / 65535.0f))
#include "visibility/map_lookup.inl"

/// visibility [stride]: share of the tests passed, 1 where nothing was to be tested.
/// weight: sum of the weights of one view's tests.
kernel void map_average(const int stride, const int views, const int weight,
                        global const uint* restrict state, global const uint* restrict hidden,
                        global float* restrict visibility) {
    const int pixel = get_global_id(0);
    if (pixel >= stride) return;
    const float total = (float)views * (float)weight;
    visibility[pixel] =
        state[pixel] == STATE_TESTED ? (total - (float)hidden[pixel]) / total : 1.0f;
}
