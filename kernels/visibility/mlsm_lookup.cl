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
#include "visibility/mlsm_light.h"
#include "visibility/mlsm_taps.h"

/// Weight of a level for a filter size: a hat between its neighbours' widths; the first and the last level answer for
/// all smaller and larger ones.
inline VF mlsmHat(const MlsmParams* p, int level, VF size) {
    const float width = p->width[level], finer = p->width[max(level - 1, 0)];
    VF hat = (VF)1.0f;
    if (level > 0) hat = min(hat, (size - finer) * (1.0f / (width - finer)));
    if (level + 1 < p->levels) {
        const float coarser = p->width[level + 1];
        hat = min(hat, (coarser - size) * (1.0f / (coarser - width)));
    }
    return max(hat, (VF)0.0f);
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
                const VI end = V_SELECT(taps->next[i], taps->end[i], skips);
                const VI from = mlsmSearch(fragments, taps->next[i], end, first, values);
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

/// Share of a rectangle above a plane: the light's, whose points (s, t) in [-1, 1]^2 are at heights c + a s + b t.
inline VF mlsmAbove(VF c, VF a, VF b) {
    const VF least = max(max(fabs(a), fabs(b)), (VF)1e-20f) * 1e-3f;
    a = max(fabs(a), least);
    b = max(fabs(b), least);
    const VF p = max(c + a + b, (VF)0.0f), q = max(c + a - b, (VF)0.0f);
    const VF s = max(c - a + b, (VF)0.0f), t = max(c - a - b, (VF)0.0f);
    const VF share = ((p - q) * (p + q) - (s - t) * (s + t)) / (8.0f * a * b);
    // Far from the plane the differences cancel
    const VF cut = clamp(share, (VF)0.0f, (VF)1.0f);
    return V_SELECT(V_SELECT(cut, (VF)1.0f, V_MASK(c >= a + b)), (VF)0.0f, V_MASK(c <= -a - b));
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
    const MlsmReceiver r =
        mlsmReceiverAt(light, bias, lookup, stride, pixel, tested, receiver, gradientX, gradientY, facing);
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
