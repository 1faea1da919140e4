// SPDX-License-Identifier: MIT
// LANES receivers, and the four lists around each of them on a level, merged on the way.
#ifndef MLSM_TAPS_H
#define MLSM_TAPS_H
#include "lib/lanes.h"
#include "shared/mlsm.h"
#include "shared/multi_view.h"

// Four lists' fragments within this share of the level's filter size are one surface
#define MLSM_CLUSTER 0.5f
// Fragments down to this share of the smallest filter size that a level answers for belong to what it sees
#define MLSM_BEHIND 0.5f

/// LANES receivers in the central view.
typedef struct {
    VF a, b, w;
    VF stepX, stepY;  ///< of the receiver's plane, per base texel
    VF margin;        ///< of depth, before the plane
    VF slope;         ///< of depth, half a texel of the base level along the plane
    VF footprint;     ///< of the pixel, base texels
} MlsmReceiver;

/// Four lists of a level around LANES places.
typedef struct {
    VI next[4], end[4];
    VF depth[4];   ///< of the next fragment; -1: none before the receiver
    VF limit[4];   ///< depth of the receiver's plane there
    VF weight[4];  ///< bilinear
} MlsmTaps;

/// The next fragment's depth, -1 past the end or behind the receiver.
inline VF mlsmDepthOf(global const float* restrict fragments, VI next, VI end, VF limit, int values) {
    const VI some = V_MASK(next < end);
    const VF depth = V_GATHER_(VF, fragments, V_SELECT((VI)0, next * values, some));
    return V_SELECT((VF)-1.0f, depth, some & V_MASK(depth > limit));
}

/// First fragment of each lane's list that is not nearer to the light than `nearest`.
inline VI mlsmSearch(global const float* restrict fragments, VI begin, VI end, VF nearest, int values) {
    for (VI open = V_MASK(begin < end); V_ANY(open); open = V_MASK(begin < end)) {
        const VI middle = (begin + end) >> 1;
        const VF depth = V_GATHER_(VF, fragments, V_SELECT((VI)0, middle * values, open));
        const VI nearer = V_MASK(depth > nearest);
        begin = V_SELECT(begin, middle + 1, open & nearer);
        end = V_SELECT(end, middle, open & ~nearer);
    }
    return begin;
}

/// Finds the lists around (u, v); returns the lanes whose lists hold something before the receiver, at any depth.
inline VI mlsmTapsAt(const MlsmParams* p, int level, const MlsmReceiver* r, VF u, VF v, VI active,
                     global const uint* restrict lists, MlsmTaps* taps, VF* nearest) {
    const int size = p->size[level];
    const float spacing = p->spacing[level], origin = p->origin[level], scale = 1.0f / spacing;
    const VF x = clamp((u - origin) * scale, (VF)0.0f, (VF)(float)(size - 1));
    const VF y = clamp((v - origin) * scale, (VF)0.0f, (VF)(float)(size - 1));
    const VF column = floor(x), row = floor(y), fx = x - column, fy = y - row;
    const VF slope = r->margin + r->slope * (float)(1 << level);
    *nearest = (VF)0.0f;
    VI some = (VI)0;
    for (int i = 0; i < 4; ++i) {
        const VF c = min(column + (float)(i & 1), (VF)(float)(size - 1));
        const VF l = min(row + (float)(i >> 1), (VF)(float)(size - 1));
        const VI list = (p->firstList[level] + V_TO_INT(l) * size + V_TO_INT(c)) * MLSM_LIST;
        taps->weight[i] = ((i & 1) ? fx : 1.0f - fx) * ((i >> 1) ? fy : 1.0f - fy);
        const VF dx = fma(c, (VF)spacing, origin - r->a), dy = fma(l, (VF)spacing, origin - r->b);
        const VF plane = fma(r->stepX, dx, r->stepY * dy);
        taps->limit[i] = max(r->w + max(plane, (VF)0.0f) + slope, (VF)0.0f);
        const VF front = V_AS_FLOAT(V_GATHER_(VI, lists + 2, list));
        const VI holds = V_MASK(front > taps->limit[i]) & active;
        taps->next[i] = V_SELECT((VI)0, V_GATHER_(VI, lists, list), holds);
        taps->end[i] = V_SELECT((VI)0, V_GATHER_(VI, lists + 1, list), holds);
        *nearest = max(*nearest, front);
        some |= V_MASK(front > r->w);
    }
    return some & active;
}

/// Merges the next fragments of four lists: of each the first, where it is near the nearest one. Returns their depth.
inline VF mlsmNext(MlsmTaps* taps, VF front, float together, VI live, global const float* restrict fragments,
                   const int values, VF* coverage, VF* taken) {
    const VF back = max(front - together, (VF)0.0f);
    VF sum = (VF)0.0f, depths = (VF)0.0f;
    for (int c = 0; c < 3; ++c) taken[c] = (VF)0.0f;
    for (int i = 0; i < 4; ++i) {
        const VI takes = live & V_MASK(taps->depth[i] >= back);
        const VI at = V_SELECT((VI)0, taps->next[i] * values, takes);
        const VF weight = V_SELECT((VF)0.0f, taps->weight[i], takes);
        const VF covered = weight * V_GATHER_(VF, fragments + 1, at);
        sum += covered;
        depths = fma(covered, taps->depth[i], depths);
        for (int c = 0; c + 2 < values; ++c) taken[c] += weight * V_GATHER_(VF, fragments + 2 + c, at);
        taps->next[i] -= takes;
        const VF next = mlsmDepthOf(fragments, taps->next[i], taps->end[i], taps->limit[i], values);
        taps->depth[i] = V_SELECT(taps->depth[i], next, takes);
    }
    if (values == 2) taken[0] = sum;
    *coverage = sum;
    return depths / max(sum, (VF)1e-30f);
}

/// Distance between neighbouring receivers in the map, the smaller one of both sides; 0 where neither is tested.
inline VF mlsmNeighbour(global const float* restrict receiver, int stride, int pixel, int step, const MlsmReceiver* r) {
    VF least = (VF)1e30f;
    for (int side = -1; side <= 1; side += 2) {
        const int other = clamp(pixel + side * step, 0, stride - LANES);
        const VF dx = V_LOAD(receiver, RECEIVER_A * stride + other) - r->a;
        const VF dy = V_LOAD(receiver, RECEIVER_B * stride + other) - r->b;
        const VI tested = V_MASK(V_LOAD(receiver, RECEIVER_W * stride + other) > 0.0f);
        least = V_SELECT(least, min(least, max(fabs(dx), fabs(dy))), tested);
    }
    return V_SELECT(least, (VF)0.0f, V_MASK(least >= 1e30f));
}

inline MlsmReceiver mlsmReceiverAt(const MultiViewParams* light, const LookupParams* bias,
                                   const MlsmLookupParams* lookup, int stride, int pixel, VI tested,
                                   global const float* restrict receiver, VF gradientX, VF gradientY, VF facing) {
    MlsmReceiver r;
    r.w = V_LOAD(receiver, RECEIVER_W * stride + pixel);
    // Lanes without a receiver look up something, but nothing comes of it
    r.a = V_SELECT((VF)0.0f, V_LOAD(receiver, RECEIVER_A * stride + pixel), tested);
    r.b = V_SELECT((VF)0.0f, V_LOAD(receiver, RECEIVER_B * stride + pixel), tested);
    // A plane that the light's centre does not see has no depth in the map
    const VI above = V_MASK(facing > 0.0f) & tested;
    const VF inverse = V_SELECT((VF)0.0f, -1.0f / V_SELECT((VF)1.0f, facing, above), above);
    r.stepX = gradientX * inverse;
    r.stepY = gradientY * inverse;
    r.slope = (fabs(r.stepX) + fabs(r.stepY)) * (0.5f * bias->slopeBias);
    r.margin = r.w * (bias->constantTexels / light->focal + r.w * (bias->constantMetres / light->near));
    r.footprint = (VF)0.0f;
    if (lookup->antialias) {
        const VF across = mlsmNeighbour(receiver, stride, pixel, 1, &r);
        const VF down = mlsmNeighbour(receiver, stride, pixel, lookup->receiverWidth, &r);
        // Blended fragments have no neighbours
        const VI onScreen = V_MASK(V_INDEX + pixel < lookup->antialias);
        r.footprint = V_SELECT((VF)0.0f, max(across, down) / lookup->pixelStep, onScreen);
    }
    return r;
}

#endif
