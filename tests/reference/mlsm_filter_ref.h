// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/mlsm_filter.cl in double: merging by sorting all fragments of four
// lists.
#pragma once
#include "host/visibility/mlsm_filter.h"
#include "tests/reference/mlsm_lists_ref.h"

namespace penumbra::tests {

/// Sums two opacities of one list: shared::MLSM_*.
MlsmFragment mlsmSumReference(int how, const MlsmFragment& sum, const MlsmFragment& more);

/// A level from the one below. epsilon: of the level, share of the depth.
std::vector<MlsmList> mlsmMergeReference(const std::vector<MlsmList>& below, int belowSize,
                                         const shared::MlsmFilterParams& step, int size,
                                         double epsilon, int how);

}  // namespace penumbra::tests
