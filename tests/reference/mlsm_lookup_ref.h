// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/mlsm_lookup.cl in double: the lookup as text.
#pragma once
#include "host/visibility/mlsm_filter.h"
#include "tests/reference/map_lookup_ref.h"
#include "tests/reference/mlsm_lists_ref.h"

namespace penumbra::tests {

struct MlsmLookupReference {
    double reach = 0;  ///< base texels of filter per unit of depth
    double stepX = 0, stepY = 0;
    int parts = 1;
    bool multiply = false;
    double constantTexels = 0.25, slopeBias = 0;
};

/// Visibility per channel of a receiver.
std::array<double, 3> mlsmVisibilityReference(const PlaneReceiver& receiver,
                                              const ViewGeometry& view,
                                              const visibility::MlsmLevels& levels,
                                              const std::vector<std::vector<MlsmList>>& lists,
                                              const MlsmLookupReference& settings);

}  // namespace penumbra::tests
