// SPDX-License-Identifier: MIT
// Coarser levels of a multi-layer shadow map: a pyramid whose coarsest part may be a stack of equal
// size.
#pragma once
#include <vector>

#include "host/visibility/mlsm_lists.h"

namespace penumbra::visibility {

/// Levels and how each is made of the one below.
struct MlsmLevels {
    shared::MlsmParams params{};  ///< all but capacity and what depends on scene and light
    std::vector<shared::MlsmFilterParams> steps;  ///< [level - 1]
    std::uint64_t lists = 0;                      ///< of all levels
};

/// As many levels as filters up to `largest` base texels need: beyond, none would be read.
MlsmLevels planMlsmLevels(const MlsmSettings& settings, double largest);

class MlsmFilter {
  public:
    explicit MlsmFilter(const runtime::Program& mlsm);
    /// Enqueues all levels above the base. Kernels: kernels/visibility/mlsm_filter.cl
    void run(const MlsmLevels& levels, MlsmMap& map);

  private:
    using Merge = runtime::Kernel<shared::MlsmParams, shared::MlsmFilterParams,
                                  Buffer<std::uint32_t>, Buffer<float>, Buffer<std::uint32_t>>;
    Merge filter_, colour_;
};

}  // namespace penumbra::visibility
