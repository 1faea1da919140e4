// SPDX-License-Identifier: MIT
// How opacities of one list add up [MLSM] 4.2.
#ifndef LIB_MLSM_ACCUMULATE_H
#define LIB_MLSM_ACCUMULATE_H
#include "shared/mlsm.h"

inline float mlsmAccumulate(int how, float sum, float value) {
    if (how == MLSM_ADD) return sum + value;
    return how == MLSM_MAX ? max(sum, value) : sum + value - sum * value;
}

#endif
