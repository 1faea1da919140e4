// SPDX-License-Identifier: MIT
// A pixel of the G-buffer as a light sees it: where its shadow tests start, and whether it has any.
#ifndef LIB_RECEIVER_H
#define LIB_RECEIVER_H
#include "lib/shadow_origin.h"
#include "lib/transform.h"
#include "shared/gbuffer.h"
#include "shared/mesh.h"
#include "shared/multi_view.h"

typedef struct {
    float3 origin;       ///< world, re-based: start of shadow tests
    float3 normal;       ///< geometric
    float x, y, z;       ///< origin in the light's frame
    float nx, ny;        ///< normal in the light's frame
    float facing;        ///< -n.(origin - light centre)
    uint state;          ///< STATE_*
} Receiver;

/// halfWidth, halfHeight: of the light, metres. Background, pixels behind the light and pixels below whose
/// horizon the whole light lies are masked; what receives no shadows is lit.
inline Receiver receiverAt(const ReceiverParams* image, const Affine* lightFromWorld, float halfWidth,
                           float halfHeight, global const float* restrict planes, int pixel) {
    const int stride = image->planeStride;
    Receiver r;
    r.state = STATE_MASKED;
    if (as_uint(planes[GB_OBJECT * stride + pixel]) == 0) return r;
    const float3 position = (float3)(planes[GB_POSITION * stride + pixel],
                                     planes[(GB_POSITION + 1) * stride + pixel],
                                     planes[(GB_POSITION + 2) * stride + pixel]);
    r.normal = (float3)(planes[GB_GEOMETRIC * stride + pixel], planes[(GB_GEOMETRIC + 1) * stride + pixel],
                        planes[(GB_GEOMETRIC + 2) * stride + pixel]);
    r.origin = shadowOrigin(position, r.normal, image->originOffset, image->worldMagnitude);
    r.x = dotPoint(lightFromWorld->row[0], r.origin.x, r.origin.y, r.origin.z);
    r.y = dotPoint(lightFromWorld->row[1], r.origin.x, r.origin.y, r.origin.z);
    r.z = dotPoint(lightFromWorld->row[2], r.origin.x, r.origin.y, r.origin.z);
    r.nx = dotVector(lightFromWorld->row[0], r.normal.x, r.normal.y, r.normal.z);
    r.ny = dotVector(lightFromWorld->row[1], r.normal.x, r.normal.y, r.normal.z);
    const float nz = dotVector(lightFromWorld->row[2], r.normal.x, r.normal.y, r.normal.z);
    r.facing = -(r.nx * r.x + r.ny * r.y + nz * r.z);
    if (r.z <= 0.0f || r.facing + fabs(r.nx) * halfWidth + fabs(r.ny) * halfHeight <= 0.0f) return r;
    r.state = as_uint(planes[GB_FLAGS * stride + pixel]) & DRAW_RECEIVES ? STATE_TESTED : STATE_LIT;
    return r;
}

#endif
