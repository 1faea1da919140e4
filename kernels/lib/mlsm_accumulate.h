// SPDX-License-Identifier: MIT
// How opacities of one list add up [MLSM] 4.2.
#ifndef LIB_MLSM_ACCUMULATE_H
#define LIB_MLSM_ACCUMULATE_H
#include "shared/mlsm.h"

/// Adds a fragment's coverage and what it takes per channel, value [values - 1], to sum.
inline void mlsmAccumulate(int how, float* sum, const float* value, const int values) {
    if (how == MLSM_COVER) {
        const float beside = min(value[0], max(1.0f - sum[0], 0.0f)), behind = value[0] - beside;
        const float inverse = value[0] > 0.0f ? 1.0f / value[0] : 0.0f;
        sum[0] += beside;
        for (int c = 1; c + 1 < values; ++c) {
            const float opacity = value[c] * inverse;
            const float through = 1.0f - fma(beside, opacity, sum[c]);
            sum[c] = 1.0f - through * (1.0f - min(behind, 1.0f) * opacity);
        }
        return;
    }
    for (int c = 0; c + 1 < values; ++c) {
        if (how == MLSM_ADD) sum[c] += value[c];
        if (how == MLSM_MAX) sum[c] = max(sum[c], value[c]);
        if (how == MLSM_MULTIPLY) sum[c] += value[c] - sum[c] * value[c];
    }
}

#endif
