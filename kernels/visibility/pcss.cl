// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows: one map from the light's centre, the average blocker gives the penumbra.
//   receiver --blocker search--> mean distance --parallel planes--> filter size --tests--> hidden count
// Source: Fernando, Percentage-Closer Soft Shadows, 2005, with the taps of [VWSS] 4 (64 + 96).
// Differs: both disks are cut exactly out of the light's cone: a tap at light sample k looks at a + k (w' - w),
// w' the depth of the near plane or of the mean blocker. Taps whose sample lies below the receiver's plane are hidden,
// as for every technique here; the map is compared with the receiver's plane at each tap (planeBias).
#include "lib/lanes.h"
#include "shared/multi_view.h"
#include "shared/single_view.h"

/// LANES receivers and their plane in the central view.
typedef struct {
    VF a, b, w, gradientX, gradientY, facing;
    VF stepX, stepY;  ///< of the plane's depth per texel
    VF cosine, sine;  ///< rotation of the pattern
    VF margin;
} PcssReceiver;

/// A sample of the light's disk: kx, ky.
inline void pcssSample(const PcssParams* p, const PcssReceiver* r, global const float* restrict pattern, int tap,
                       VF* kx, VF* ky) {
    const float x = pattern[2 * tap], y = pattern[2 * tap + 1];
    *kx = (r->cosine * x - r->sine * y) * p->reachX;
    *ky = (r->sine * x + r->cosine * y) * p->reachY;
}

/// Depth of the map where the line to sample k passes depth w + spread, and the plane's there.
inline VF pcssTap(const MultiViewParams* light, const PcssParams* p, const PcssReceiver* r, VF kx, VF ky, VF spread,
                  global const uint* restrict map, VF* reference) {
    const int size = light->resolution;
    const VF u = fma(kx, spread, r->a), v = fma(ky, spread, r->b);
    const VF column = floor(clamp(u, -2.0f, (float)(size + 1))), row = floor(clamp(v, -2.0f, (float)(size + 1)));
    const VI x = V_TO_INT(column), y = V_TO_INT(row);
    const VI inside = V_MASK(x >= 0) & V_MASK(x < size) & V_MASK(y >= 0) & V_MASK(y < size);
    const VI texel = V_SELECT((VI)(size * size), y * size + x, inside);
    const VF depth = V_SELECT((VF)0.0f, V_AS_FLOAT(V_GATHER_(VU, map, texel)), inside);
    const VF plane = p->planeBias ? r->stepX * (column + 0.5f - r->a) + r->stepY * (row + 0.5f - r->b) : (VF)0.0f;
    *reference = max(r->w + plane + r->margin, (VF)0.0f);
    return depth;
}

/// Depth w of the mean blocker; 0: there is none.
inline VF pcssBlocker(const MultiViewParams* light, const PcssParams* p, const PcssReceiver* r,
                      global const float* restrict pattern, global const uint* restrict map) {
    VF sum = (VF)0.0f, count = (VF)0.0f;
    for (int tap = 0; tap < p->blockerTaps; ++tap) {
        VF kx, ky, reference;
        pcssSample(p, r, pattern, tap, &kx, &ky);
        const VF depth = pcssTap(light, p, r, kx, ky, 1.0f - r->w, map, &reference);
        const VI blocks = V_MASK(depth > reference);
        sum += V_SELECT((VF)0.0f, 1.0f / V_SELECT((VF)1.0f, depth, blocks), blocks);  // distances, not depths
        count += V_SELECT((VF)0.0f, (VF)1.0f, blocks);
    }
    return V_SELECT((VF)0.0f, count / max(sum, (VF)1e-20f), V_MASK(count > 0.0f));
}

/// One work-item per LANES receivers: adds the failed tests of filterTaps.
/// patterns   [blockerTaps + filterTaps, 2]  points of the unit disk
/// rotations  [PCSS_ROTATIONS, 2]            cosine, sine
kernel void pcss(const MultiViewParams light, const LookupParams bias, const PcssParams params, const int stride,
                 global const float* restrict receiver, global const float* restrict patterns,
                 global const float* restrict rotations, global const uint* restrict map,
                 global uint* restrict hidden) {
    const int pixel = (int)get_global_id(0) * LANES;
    if (pixel >= stride) return;
    PcssReceiver r;
    r.w = V_LOAD(receiver, RECEIVER_W * stride + pixel);
    const VI tested = V_MASK(r.w > 0.0f);
    if (!V_ANY(tested)) return;
    r.a = V_LOAD(receiver, RECEIVER_A * stride + pixel);
    r.b = V_LOAD(receiver, RECEIVER_B * stride + pixel);
    r.gradientX = V_LOAD(receiver, RECEIVER_GRADIENT_X * stride + pixel);
    r.gradientY = V_LOAD(receiver, RECEIVER_GRADIENT_Y * stride + pixel);
    r.facing = V_LOAD(receiver, RECEIVER_FACING * stride + pixel);
    const VI above = V_MASK(r.facing > 0.0f);
    const VF inverse = V_SELECT((VF)0.0f, -1.0f / V_SELECT((VF)1.0f, r.facing, above), above);
    r.stepX = r.gradientX * inverse;
    r.stepY = r.gradientY * inverse;
    r.margin = r.w * (bias.constantTexels / light.focal + r.w * (bias.constantMetres / light.near)) +
               (fabs(r.stepX) + fabs(r.stepY)) * (0.5f * bias.slopeBias);
    const VI index = V_INDEX + pixel, row = index / params.receiverWidth, column = index - row * params.receiverWidth;
    const VI rotation = 2 * ((row & 15) * 16 + (column & 15));
    r.cosine = V_GATHER_(VF, rotations, rotation);
    r.sine = V_GATHER_(VF, rotations, rotation + 1);

    const VF blocker = pcssBlocker(&light, &params, &r, patterns, map);
    // Parallel planes: the penumbra in the map is the light's disk times the difference of depths
    const VF spread = max(blocker - r.w, (VF)params.leastSpread);
    const VI shadowed = V_MASK(blocker > 0.0f);
    global const float* pattern = patterns + 2 * params.blockerTaps;
    VI count = (VI)0;
    for (int tap = 0; tap < params.filterTaps; ++tap) {
        VF kx, ky, reference;
        pcssSample(&params, &r, pattern, tap, &kx, &ky);
        const VF depth = pcssTap(&light, &params, &r, kx, ky, spread, map, &reference);
        const VI below = V_MASK(r.facing + r.gradientX * kx + r.gradientY * ky <= 0.0f);
        count -= (V_MASK(depth > reference) & shadowed) | below;
    }
    const VI sum = V_AS_INT(V_LOAD(hidden, pixel)) + (count & tested);
    V_STORE(V_AS_UINT(sum), hidden, pixel);
}
