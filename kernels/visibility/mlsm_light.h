// SPDX-License-Identifier: MIT
// What fragments take of the light of LANES receivers: added up, or multiplied, and bounded by what each level sees.
#ifndef MLSM_LIGHT_H
#define MLSM_LIGHT_H
#include "lib/lanes.h"
#include "shared/mlsm.h"

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

#endif
