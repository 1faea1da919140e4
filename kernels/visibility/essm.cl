// SPDX-License-Identifier: MIT
// Exponential soft shadow maps: one map of e^(c d), filtered beforehand; the average blocker gives the filter's size.
//   depth map --warp--> e^(c d), d --means of 2 x 2--> pyramid --two filtered reads--> visibility
// Source: Annen et al., Exponential Shadow Maps, 2008; Shen, Feng, Yang, Exponential Soft Shadow Mapping, 2013
// ([MLSM] 2, 8 compare with it).
// Differs: the average blocker comes from the filtered depth and the exponential test's own share of blockers; a box is
// 8 x 8 texels of a pyramid, each tested alone against the receiver's plane, instead of a summed-area table, whose sums
// of e^80 leave float.
#include "lib/exponential.h"
#include "shared/multi_view.h"
#include "shared/single_view.h"

#define ESSM_TAPS 8  // along each side of a box

inline VF essmDepth(const EssmParams* p, VF z) {
    return clamp((z - p->nearZ) * p->inverseRange, (VF)0.0f, (VF)1.0f);
}

/// One work-item per texel: level 0 of pyramid [2, texels]. The test needs receivers in the map: where no caster is,
/// `receivers` (all that is drawn) gives the depth.
kernel void essm_base(const MultiViewParams light, const EssmParams params, global const uint* restrict casters,
                      global const uint* restrict receivers, global float* restrict pyramid) {
    const int texel = get_global_id(0);
    if (texel >= light.resolution * light.resolution) return;
    const float caster = as_float(casters[texel]), any_ = as_float(receivers[texel]);
    const float w = caster > 0.0f ? caster : any_;
    const float z = w > 0.0f ? light.near / w : INFINITY;
    const float d = clamp((z - params.nearZ) * params.inverseRange, 0.0f, 1.0f);
    float exponentials[LANES];
    V_STORE(exponential((VF)(params.exponent * d)), exponentials, 0);
    pyramid[texel] = exponentials[0];
    pyramid[params.texels + texel] = d;
}

/// One work-item per texel of `level`: the mean of four texels of the level below, the rim repeated.
kernel void essm_reduce(const EssmParams params, const int level, global float* pyramid) {
    const int texel = get_global_id(0), size = params.size[level], below = params.size[level - 1];
    if (texel >= size * size) return;
    const int x = 2 * (texel % size), y = 2 * (texel / size);
    const int right = min(x + 1, below - 1), down = min(y + 1, below - 1);
    for (int plane = 0; plane < 2; ++plane) {
        global const float* from = pyramid + plane * params.texels + params.firstTexel[level - 1];
        pyramid[plane * params.texels + params.firstTexel[level] + texel] =
            0.25f * ((from[y * below + x] + from[y * below + right]) + (from[down * below + x] + from[down * below + right]));
    }
}

/// A receiver's plane in the central view.
typedef struct {
    VF a, b, w, stepX, stepY;
    VF towards;       ///< factor on distances: the bias
    VF slopeX, slopeY;  ///< steps of c d per texel
} EssmPlane;

/// sinh(x) / x: the mean of e^(x t) over t in [-1, 1].
inline VF essmMean(VF x) {
    x = min(fabs(x), (VF)40.0f);
    const VF e = exponential(x);
    return V_SELECT(0.5f * (e - 1.0f / e) / max(x, (VF)1e-3f), fma(x * x, (VF)(1.0f / 6.0f), (VF)1.0f), V_MASK(x < 0.1f));
}

/// One texel of a level, each lane at a level of its own: share of it that does not block, and its mean depth.
/// On a sloping receiver the mean of e^(c d) over a texel is larger than at its centre, by `excess`: without dividing
/// by it, slopes would outweigh blockers.
inline void essmTexel(const MultiViewParams* light, const LookupParams* bias, const EssmParams* p, const EssmPlane* r,
                      global const float* restrict pyramid, VI first, VI size, VF texel, VF excess, VF u, VF v, VF* passed,
                      VF* depth, VF* receiver) {
    const VF last = V_TO_FLOAT(size - 1);
    const VF column = floor(clamp(u / texel, (VF)0.0f, last)), row = floor(clamp(v / texel, (VF)0.0f, last));
    const VI index = first + V_TO_INT(row) * size + V_TO_INT(column);
    const VF x = (column + 0.5f) * texel - r->a, y = (row + 0.5f) * texel - r->b;
    const VF w = fma(r->stepX, x, fma(r->stepY, y, r->w));
    const VF z = light->near / max(w, (VF)1e-6f) * r->towards - bias->constantMetres;
    *receiver = essmDepth(p, z);
    *depth = V_GATHER_(VF, pyramid + p->texels, index);
    const VF most = V_SELECT(excess, (VF)1.0f, V_MASK(*receiver >= 1.0f));
    *passed = min(V_GATHER_(VF, pyramid, index) * exponential(*receiver * -p->exponent) / most, (VF)1.0f);
}

/// Over the box of half sizes radiusX, radiusY texels around the receiver: share that does not block, and the sum of
/// the blockers' depths times their share.
inline void essmBox(const MultiViewParams* light, const LookupParams* bias, const EssmParams* p, const EssmPlane* r,
                    global const float* restrict pyramid, VF radiusX, VF radiusY, VF* lit, VF* blockers) {
    // The levels around a tap's share of the box, read off the exponent
    const VF step = max(max(radiusX, radiusY) * (2.0f / ESSM_TAPS), (VF)1.0f);
    const VI level = clamp((V_AS_INT(step) >> 23) - 127, (VI)0, (VI)(p->levels - 1));
    const VI upper = min(level + 1, (VI)(p->levels - 1));
    const VF texel0 = V_AS_FLOAT((127 + level) << 23), texel1 = V_AS_FLOAT((127 + upper) << 23);
    const VF blend = clamp(step / texel0 - 1.0f, (VF)0.0f, (VF)1.0f);
    const VI first0 = V_GATHER_(VI, p->firstTexel, level), first1 = V_GATHER_(VI, p->firstTexel, upper);
    const VI size0 = V_GATHER_(VI, p->size, level), size1 = V_GATHER_(VI, p->size, upper);
    const VF excess0 = essmMean(r->slopeX * texel0 * 0.5f) * essmMean(r->slopeY * texel0 * 0.5f);
    const VF excess1 = essmMean(r->slopeX * texel1 * 0.5f) * essmMean(r->slopeY * texel1 * 0.5f);
    VF sumLit = (VF)0.0f, sumBlockers = (VF)0.0f;
    for (int tap = 0; tap < ESSM_TAPS * ESSM_TAPS; ++tap) {
        const VF u = r->a + radiusX * (((float)(tap % ESSM_TAPS) + 0.5f) * (2.0f / ESSM_TAPS) - 1.0f);
        const VF v = r->b + radiusY * (((float)(tap / ESSM_TAPS) + 0.5f) * (2.0f / ESSM_TAPS) - 1.0f);
        VF passed0, depth0, receiver0, passed1, depth1, receiver1;
        essmTexel(light, bias, p, r, pyramid, first0, size0, texel0, excess0, u, v, &passed0, &depth0, &receiver0);
        essmTexel(light, bias, p, r, pyramid, first1, size1, texel1, excess1, u, v, &passed1, &depth1, &receiver1);
        sumLit += passed0 + (passed1 - passed0) * blend;
        // Mean depth = blockers' share x theirs + the rest at the receiver's
        const VF blocked0 = clamp(depth0 - passed0 * receiver0, (VF)0.0f, (1.0f - passed0) * receiver0);
        const VF blocked1 = clamp(depth1 - passed1 * receiver1, (VF)0.0f, (1.0f - passed1) * receiver1);
        sumBlockers += blocked0 + (blocked1 - blocked0) * blend;
    }
    *lit = sumLit * (1.0f / (ESSM_TAPS * ESSM_TAPS));
    *blockers = sumBlockers * (1.0f / (ESSM_TAPS * ESSM_TAPS));
}

#define ESSM_WEIGHT 65535

/// One work-item per LANES receivers: adds the share hidden, in 1/ESSM_WEIGHT.
kernel void essm(const MultiViewParams light, const LookupParams bias, const EssmParams params, const int stride,
                 global const float* restrict receiver, global const float* restrict pyramid,
                 global uint* restrict hidden) {
    const int pixel = (int)get_global_id(0) * LANES;
    if (pixel >= stride) return;
    const VF w = V_LOAD(receiver, RECEIVER_W * stride + pixel);
    const VI tested = V_MASK(w > 0.0f);
    if (!V_ANY(tested)) return;
    const VF a = V_LOAD(receiver, RECEIVER_A * stride + pixel), b = V_LOAD(receiver, RECEIVER_B * stride + pixel);
    const VF gradientX = V_LOAD(receiver, RECEIVER_GRADIENT_X * stride + pixel);
    const VF gradientY = V_LOAD(receiver, RECEIVER_GRADIENT_Y * stride + pixel);
    const VF facing = V_LOAD(receiver, RECEIVER_FACING * stride + pixel);
    const VI above_ = V_MASK(facing > 0.0f);
    const VF inverse = V_SELECT((VF)0.0f, -1.0f / V_SELECT((VF)1.0f, facing, above_), above_);
    const VF towards = (VF)(1.0f - bias.constantTexels / light.focal);
    EssmPlane r = {a, b, V_SELECT((VF)1.0f, w, tested), gradientX * inverse, gradientY * inverse, towards};
    const VF steepness = params.exponent * params.inverseRange * light.near / (r.w * r.w);
    r.slopeX = r.stepX * steepness;
    r.slopeY = r.stepY * steepness;

    // Blockers of the whole cone between receiver and light
    VF lit, blockers;
    essmBox(&light, &bias, &params, &r, pyramid, (1.0f - w) * params.reachX, (1.0f - w) * params.reachY, &lit, &blockers);
    const VF share = 1.0f - lit;
    const VI shadowed = V_MASK(share > 1e-3f);
    const VF distance = fma(blockers / max(share, (VF)1e-3f), (VF)(1.0f / params.inverseRange), (VF)params.nearZ);
    const VF spread = max(light.near / max(distance, (VF)light.near) - w, (VF)0.0f);
    essmBox(&light, &bias, &params, &r, pyramid, max(spread * params.reachX, (VF)params.leastRadius),
            max(spread * params.reachY, (VF)params.leastRadius), &lit, &blockers);
    lit = V_SELECT((VF)1.0f, lit, shadowed);
    lit = max(lit - params.leak, (VF)0.0f) * (1.0f / (1.0f - params.leak));

    // The part of the light below the receiver's plane is hidden by the receiver itself: 4 x 4 points of it
    VI above = (VI)0;
    for (int i = 0; i < 16; ++i) {
        const float kx = ((float)(i % 4) - 1.5f) * 0.5f * params.reachX, ky = ((float)(i / 4) - 1.5f) * 0.5f * params.reachY;
        above -= V_MASK(facing + gradientX * kx + gradientY * ky > 0.0f);
    }
    lit = min(lit, V_TO_FLOAT(above) * (1.0f / 16.0f));
    const VI count = ESSM_WEIGHT - V_TO_INT(fma(lit, (VF)ESSM_WEIGHT, (VF)0.5f));
    const VI sum = V_AS_INT(V_LOAD(hidden, pixel)) + (count & tested);
    V_STORE(V_AS_UINT(sum), hidden, pixel);
}
