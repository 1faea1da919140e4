// SPDX-License-Identifier: MIT
// Visibility from filtered lists: each level answers for the depths at which its filter fits the light.
//   receivers --per level: interval of depth, four lists--> opacities before it --hat over two levels--> hidden weights
// Source: [MLSM] 5.1 (filter size, intervals, figure 9), 5.2 (two levels, anti-aliasing), 6 (accumulation).
// Differs: - A level stands for the filter as wide as its box and the tent of the bilinear read together: their
//   variance is that of a box of `width`. The paper takes the box alone, which makes shadows softer than they are.
// - The four lists are merged on the way, so that a surface has one depth and with it one weight at the receiver's
//   place on each level. Bilinear reads of four weights instead add up to less than 1 on sloping surfaces.
// - Levels see a surface at slightly different depths, so that their hats need not add up to 1. No more comes through
//   than through the levels that answer, each with whole weights: what all of them see covered stays hidden.
// - Fragments count only before the receiver's plane at their own texel, so that a sloping receiver does not hide
//   itself. The part of the light below that plane is hidden by the receiver.
// - accumulateLookup=multiply adds what two levels make of a surface between their widths, and multiplies only what
//   belongs to other widths: the paper's product of all lets light through whatever two levels share.
// - Coverage adds up until all is covered; what covers more lies behind that, and multiplies. Where all is opaque this
//   is the paper's sum, clamped.
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

/// What is known of the light of LANES receivers. Coverage adds up to a layer; a layer that covers all is put before
/// what is behind it, and multiplies.
typedef struct {
    VF uncovered;   ///< share that the layer at hand leaves open
    VF layer[3];    ///< share that comes through it, per channel
    VF through[3];  ///< share that comes through the layers before it
    // With accumulateLookup=multiply: what comes through fragments of this level that the level below, or the one above
    // sees too, and what the one above takes by those fragments
    VF finer[3], coarser[3], above[3];
} MlsmLight;

/// What comes through at most: as much as through any of the levels that answer for something.
typedef struct {
    VF most[3];
    VF above[3];  ///< through the level above, each fragment with its whole weight
    VI shares;    ///< lanes where the level above leaves a part of its answer to this one
} MlsmBound;

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
        const VF plane = fma(r->stepX, fma(c, (VF)spacing, origin - r->a), r->stepY * fma(l, (VF)spacing, origin - r->b));
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

/// Weight of a level for a filter size: a hat between its neighbours' widths; the first and the last level answer for
/// all smaller and larger ones.
inline VF mlsmHat(const MlsmParams* p, int level, VF size) {
    const float width = p->width[level];
    VF hat = (VF)1.0f;
    if (level > 0)
        hat = clamp((size - p->width[level - 1]) * (1.0f / (width - p->width[level - 1])), (VF)0.0f, (VF)1.0f);
    if (level + 1 < p->levels)
        hat = min(hat, clamp((p->width[level + 1] - size) * (1.0f / (p->width[level + 1] - width)), (VF)0.0f, (VF)1.0f));
    return hat;
}

/// Takes from the light what fragments of this coverage take; taken[]: per channel, times coverage; finer: lanes whose
/// filter is smaller than the level's width.
inline void mlsmTake(MlsmLight* light, int accumulate, VI finer, VF hat, VF coverage, const VF* taken,
                     const int channels) {
    if (accumulate == MLSM_MULTIPLY) {
        for (int c = 0; c < channels; ++c) {
            const VF through = max(1.0f - taken[c] * hat, (VF)0.0f);
            light->finer[c] *= V_SELECT((VF)1.0f, through, finer);
            light->coarser[c] *= V_SELECT(through, (VF)1.0f, finer);
        }
        return;
    }
    const VF covered = min(coverage * hat, light->uncovered + 1.0f), beside = min(covered, light->uncovered);
    const VF behind = covered - beside, inverse = 1.0f / max(coverage, (VF)1e-30f);
    light->uncovered -= beside;
    const VI full = V_MASK(light->uncovered <= 0.0f);
    for (int c = 0; c < channels; ++c) {
        const VF opacity = min(taken[c] * inverse, (VF)1.0f);
        light->layer[c] = max(fma(-beside, opacity, light->layer[c]), (VF)0.0f);
        if (channels == 1) continue;  // opaque: nothing comes through a full layer
        light->through[c] *= V_SELECT((VF)1.0f, light->layer[c], full);
        light->layer[c] = V_SELECT(light->layer[c], max(fma(-behind, opacity, (VF)1.0f), (VF)0.0f), full);
    }
    if (channels == 3) light->uncovered = V_SELECT(light->uncovered, 1.0f - behind, full);
}

inline MlsmLight mlsmWholeLight(void) {
    MlsmLight light;
    light.uncovered = (VF)1.0f;
    for (int c = 0; c < 3; ++c) {
        light.layer[c] = light.through[c] = light.finer[c] = light.coarser[c] = (VF)1.0f;
        light.above[c] = (VF)0.0f;
    }
    return light;
}

/// After a level: closes the filter sizes between it and the level above.
inline void mlsmMultiplyLevel(MlsmLight* light, const int channels) {
    for (int c = 0; c < channels; ++c) {
        light->through[c] *= 1.0f - min(light->above[c] + (1.0f - light->coarser[c]), (VF)1.0f);
        light->above[c] = 1.0f - light->finer[c];
        light->finer[c] = light->coarser[c] = (VF)1.0f;
    }
}

/// What comes through where each fragment has its whole weight, in channel c.
inline VF mlsmThrough(const MlsmLight* light, int accumulate, int c) {
    return accumulate == MLSM_MULTIPLY ? light->finer[c] : light->through[c] * light->layer[c];
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

/// Bounds what comes through by a level; whole: what comes through it, each fragment with its whole weight; answers:
/// lanes where it has a say; up, down: where it leaves a part to the level above, and to the one below.
inline void mlsmBoundBy(MlsmBound* bound, const VF* whole, VI answers, VI up, VI down, const int channels) {
    answers |= bound->shares;
    for (int c = 0; c < channels; ++c) {
        bound->most[c] = V_SELECT(bound->most[c], max(bound->most[c], whole[c]), answers);
        bound->most[c] = V_SELECT(bound->most[c], max(bound->most[c], bound->above[c]), up);
        bound->above[c] = whole[c];
    }
    bound->shares = down;
}

/// Adds up what one level takes around a place.
inline void mlsmLevel(const MlsmParams* p, const MlsmLookupParams* lookup, int level, const MlsmReceiver* r,
                      MlsmTaps* taps, VF nearest, VI active, global const float* restrict fragments, MlsmLight* light,
                      MlsmBound* bound, const int values) {
    const int channels = values == 2 ? 1 : 3;
    const float perDepth = lookup->reach > 0.0f ? 1.0f / lookup->reach : 0.0f;
    const float together = MLSM_CLUSTER * p->width[level] * perDepth;
    // Depths whose filter sizes this level answers for, and a little behind them
    VF farthest = (VF)0.0f;
    if (level > 0)
        farthest = V_SELECT(r->w + MLSM_BEHIND * p->width[level - 1] * perDepth, (VF)0.0f,
                            V_MASK(r->footprint > p->width[level - 1]));
    active &= V_MASK(nearest > farthest);
    VF through[3] = {(VF)1.0f, (VF)1.0f, (VF)1.0f};
    if (!V_ANY(active)) {
        mlsmBoundBy(bound, through, (VI)0, (VI)0, (VI)0, channels);
        if (lookup->accumulate == MLSM_MULTIPLY) mlsmMultiplyLevel(light, channels);
        return;
    }
    // What lies before them counts towards the bound alone
    VF open = bound->most[0];
    for (int c = 1; c < channels; ++c) open = min(open, bound->most[c]);
    if (level + 1 < p->levels) {
        const VF first = r->w + (p->width[level + 1] * perDepth + together);
        const VI skips = active & V_MASK(nearest > first) & V_MASK(open >= 1.0f);
        if (V_ANY(skips))
            for (int i = 0; i < 4; ++i) {
                const VI from = mlsmSearch(fragments, taps->next[i], V_SELECT(taps->next[i], taps->end[i], skips), first, values);
                taps->next[i] = V_SELECT(taps->next[i], from, skips);
            }
    }
    for (int i = 0; i < 4; ++i)
        taps->depth[i] = mlsmDepthOf(fragments, taps->next[i], taps->end[i], taps->limit[i], values);
    MlsmLight whole = mlsmWholeLight();
    VI answers = (VI)0, up = (VI)0, down = (VI)0;
    for (;;) {
        const VF front = max(max(taps->depth[0], taps->depth[1]), max(taps->depth[2], taps->depth[3]));
        const VI live = active & V_MASK(front > farthest);
        if (!V_ANY(live)) break;
        VF coverage, taken[3];
        const VF depth = mlsmNext(taps, front, together, live, fragments, values, &coverage, taken);
        const VF size = max((depth - r->w) * lookup->reach, r->footprint);
        const VF hat = V_SELECT((VF)0.0f, mlsmHat(p, level, size), V_MASK(coverage > 0.0f));
        const VI finer = V_MASK(size < p->width[level]), part = V_MASK(hat > 0.0f) & V_MASK(hat < 1.0f);
        mlsmTake(light, lookup->accumulate, finer, hat, coverage, taken, channels);
        mlsmTake(&whole, lookup->accumulate, live, (VF)1.0f, coverage, taken, channels);
        answers |= V_MASK(hat > 0.0f);
        up |= part & ~finer;
        down |= part & finer;
    }
    for (int c = 0; c < channels; ++c) through[c] = mlsmThrough(&whole, lookup->accumulate, c);
    mlsmBoundBy(bound, through, answers, up, down, channels);
    if (lookup->accumulate == MLSM_MULTIPLY) mlsmMultiplyLevel(light, channels);
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

/// Share of a rectangle above a plane: the light's, whose points (s, t) in [-1, 1]^2 are at heights c + a s + b t.
inline VF mlsmAbove(VF c, VF a, VF b) {
    const VF least = max(max(fabs(a), fabs(b)), (VF)1e-20f) * 1e-3f;
    a = max(fabs(a), least);
    b = max(fabs(b), least);
    const VF p = max(c + a + b, (VF)0.0f), q = max(c + a - b, (VF)0.0f);
    const VF s = max(c - a + b, (VF)0.0f), t = max(c - a - b, (VF)0.0f);
    const VF share = ((p - q) * (p + q) - (s - t) * (s + t)) / (8.0f * a * b);
    // Far from the plane the differences cancel
    return V_SELECT(V_SELECT(clamp(share, (VF)0.0f, (VF)1.0f), (VF)1.0f, V_MASK(c >= a + b)), (VF)0.0f, V_MASK(c <= -a - b));
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
        r.footprint = max(across, mlsmNeighbour(receiver, stride, pixel, lookup->receiverWidth, &r)) / lookup->pixelStep;
    }
    return r;
}

/// One work-item per LANES receivers; hidden [channels, stride]: adds what is hidden, in 1 / MLSM_WEIGHT.
inline void mlsmLookup(const MultiViewParams* light, const LookupParams* bias, const MlsmParams* p,
                       const MlsmLookupParams* lookup, int stride, global const float* restrict receiver,
                       global const uint* restrict lists, global const float* restrict fragments,
                       global uint* restrict hidden, const int values) {
    const int pixel = (int)get_global_id(0) * LANES, channels = values == 2 ? 1 : 3;
    if (pixel >= stride) return;
    const VI tested = V_MASK(V_LOAD(receiver, RECEIVER_W * stride + pixel) > 0.0f);
    if (!V_ANY(tested)) return;
    const VF gradientX = V_LOAD(receiver, RECEIVER_GRADIENT_X * stride + pixel);
    const VF gradientY = V_LOAD(receiver, RECEIVER_GRADIENT_Y * stride + pixel);
    const VF facing = V_LOAD(receiver, RECEIVER_FACING * stride + pixel);
    const MlsmReceiver r = mlsmReceiverAt(light, bias, lookup, stride, pixel, tested, receiver, gradientX, gradientY, facing);
    VF lit[3] = {(VF)0.0f, (VF)0.0f, (VF)0.0f};
    for (int part = 0; part < lookup->parts; ++part) {
        MlsmLight seen = mlsmWholeLight();
        MlsmBound bound = {{(VF)0.0f, (VF)0.0f, (VF)0.0f}, {(VF)1.0f, (VF)1.0f, (VF)1.0f}, (VI)0};
        const float offset = (float)part - 0.5f * (float)(lookup->parts - 1);
        for (int level = p->levels - 1; level >= 0; --level) {
            // Towards the part's centre, as far as what the level answers for is away
            const float size = offset * (level > 0 ? p->width[level] : 0.5f * p->width[0]);
            MlsmTaps taps;
            VF nearest;
            const VI some = mlsmTapsAt(p, level, &r, r.a + lookup->stepX * size, r.b + lookup->stepY * size, tested,
                                       lists, &taps, &nearest);
            // The four lists of a level hold all that those of finer ones do
            if (lookup->parts == 1 && !V_ANY(some)) break;
            mlsmLevel(p, lookup, level, &r, &taps, nearest, some, fragments, &seen, &bound, values);
        }
        for (int c = 0; c < channels; ++c) {
            const VF through = seen.through[c] * seen.layer[c] * (1.0f - seen.above[c]);
            const VF most = V_SELECT(bound.most[c], (VF)1.0f, bound.shares);
            lit[c] += V_SELECT((VF)1.0f, min(through, most), V_MASK(through < 1.0f));
        }
    }
    const float kx = light->halfWidth * light->focal / light->near, ky = light->halfHeight * light->focal / light->near;
    const VF above = mlsmAbove(facing, gradientX * kx, gradientY * ky);
    const float share = 1.0f / (float)lookup->parts;
    for (int c = 0; c < channels; ++c) {
        const VI weight = MLSM_WEIGHT - V_TO_INT(fma(min(lit[c] * share, above), (VF)MLSM_WEIGHT, (VF)0.5f));
        const VI sum = V_AS_INT(V_LOAD(hidden, c * stride + pixel)) + (weight & tested);
        V_STORE(V_AS_UINT(sum), hidden, c * stride + pixel);
    }
}

kernel void mlsm_lookup(const MultiViewParams light, const LookupParams bias, const MlsmParams params,
                        const MlsmLookupParams lookup, const int stride, global const float* restrict receiver,
                        global const uint* restrict lists, global const float* restrict fragments,
                        global uint* restrict hidden) {
    mlsmLookup(&light, &bias, &params, &lookup, stride, receiver, lists, fragments, hidden, MLSM_VALUES(1));
}

kernel void mlsm_lookup_colour(const MultiViewParams light, const LookupParams bias, const MlsmParams params,
                               const MlsmLookupParams lookup, const int stride, global const float* restrict receiver,
                               global const uint* restrict lists, global const float* restrict fragments,
                               global uint* restrict hidden) {
    mlsmLookup(&light, &bias, &params, &lookup, stride, receiver, lists, fragments, hidden, MLSM_VALUES(3));
}
