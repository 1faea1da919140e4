// SPDX-License-Identifier: MIT
// The parallel, coplanar views of one area light, and what is kept of receivers and points.
//
// A point at (x, y, z) in the light's frame (z along the emission) has in the central view
//   a = F x / z + C,  b = F y / z + C,  w = near / z        F = resolution / (2 tan(fov / 2)), C = resolution / 2
// and in the view of a light sample at (sx, sy)
//   u = a - kx w,  v = b - ky w,  depth = w                 kx = sx F / near, ky = sy F / near
// so that a view costs two multiply-adds: depth is reversed, 1 at the near plane, 0 at infinity.
#ifndef SHARED_MULTI_VIEW_H
#define SHARED_MULTI_VIEW_H
#include "shared/portable.h"
SHARED_BEGIN

// Planes of receivers: float [RECEIVER_PLANES, pixels]
#define RECEIVER_A 0
#define RECEIVER_B 1
#define RECEIVER_W 2         // 0: not to be tested
#define RECEIVER_GRADIENT_X 3  // near n.x / F, n the geometric normal in the light's frame
#define RECEIVER_GRADIENT_Y 4
#define RECEIVER_FACING 5    // -n.(point - light centre); plus gradient.k per view: > 0 if it faces the sample
#define RECEIVER_PLANES 6

// Shadow tests start this share of the coordinates' magnitude off the surface
#define SHADOW_ORIGIN_OFFSET 4e-6f

#define STATE_MASKED 0u  // background, or faces away from the whole light: visibility 1, not in metrics
#define STATE_TESTED 1u
#define STATE_LIT 2u      // receives no shadows
#define STATE_OUTSIDE 3u  // some view does not hold it and the views miss casters: to be traced

#define POINTS_FLOAT 0
#define POINTS_HALF 1
#define POINTS_FIXED 2

typedef struct {
    Affine lightFromWorld;  ///< rows: x, y, z of the light's frame
    float tanHalfFov;
    float near;             ///< metres
    float focal;            ///< F, texels
    float centre;           ///< C, texels
    float setBack;          ///< metres from the light to the enlarged view's eye [VWSS] eq. 1
    float nearClip;         ///< metres: nearer triangles are cut off
    float halfWidth, halfHeight;  ///< metres, of the light
    int resolution;         ///< texels, of each map
    int enlarged;           ///< pixels, of the enlarged view [VWSS] eq. 3
    int views;              ///< of the light: N
    int mapStride;          ///< texels between maps: resolution^2 and a slot for points outside
    uint pointCapacity;
    int precision;          ///< POINTS_*
    int alphaKeys;          ///< 1: points carry an opacity key
    int sampleStride;       ///< step of the opacity shuffle, coprime to views
    int depthBits;          ///< 32 or 16
    int unused[3];
} MultiViewParams;
SHARED_STRUCT(MultiViewParams, 128)

typedef struct {
    int firstView, viewCount;  ///< of this launch; map 0 of the buffer is view `mapView`
    int mapView;
    int pcf;               ///< taps: 1, 5, 9; 4: bilinear
    float slopeBias;       ///< 1: half a texel of the receiver's slope
    float constantTexels;  ///< bias in texel footprints
    float constantMetres;
    float quantum;         ///< depth step of the maps: 0 for 32 bits
    int flat;              ///< 1: taps compare with the receiver's depth, not with its plane's
    int unused[3];
} LookupParams;
SHARED_STRUCT(LookupParams, 48)

typedef struct {
    int width, height, planeStride;
    int pixelStep;        ///< 1, or 2: only pixels of even column and row become receivers
    float originOffset;   ///< shadow origin: this times the largest coordinate, along the normal
    float worldMagnitude; ///< least magnitude that the offset is taken of, metres
    int receiverWidth;    ///< receivers in a row: width / pixelStep, rounded up
    int receiverStride;   ///< floats between planes of receivers
    uint outsideState;    ///< of pixels that some view does not hold: STATE_OUTSIDE, or STATE_TESTED
    int countOutside;     ///< 1: the views do not hold all casters, so such pixels are counted
    int fragmentRows;     ///< last rows of the height: their pixels have no neighbours, each is a receiver
    int unused;
} ReceiverParams;
SHARED_STRUCT(ReceiverParams, 48)

/// Counters of one light's run, read by the host after the frame.
typedef struct {
    uint points;       ///< generated, also those that found no room
    uint outsideFov;   ///< pixels that some view does not hold
    uint nearPoints;   ///< points nearer than the near plane
    uint unused;
} MultiViewCounters;
SHARED_STRUCT(MultiViewCounters, 16)

SHARED_END
#endif
