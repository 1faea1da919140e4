// SPDX-License-Identifier: MIT
// Visibility of receivers from a filtered multi-layer shadow map.
#pragma once
#include "host/visibility/mlsm_filter.h"
#include "host/visibility/multi_view.h"

namespace penumbra::visibility {

/// How a light is looked up: cut along its longer side into squares as near as can be, each with a
/// filter of its area. Disks and spheres are squares of their area.
struct MlsmReach {
    double size = 0;              ///< base texels per unit of depth between occluder and receiver
    double stepX = 0, stepY = 0;  ///< from part to part, in units of the filter size
    int parts = 1;
};
MlsmReach mlsmReachOf(const LightView& view);

class MlsmLookup {
  public:
    MlsmLookup(const runtime::Program& mlsm, const MlsmSettings& settings);
    /// Enqueues adding what is hidden to receivers.hidden [channels, stride], in 1 / MLSM_WEIGHT.
    /// Kernels: kernels/visibility/mlsm_lookup.cl
    void run(const LightView& view, const MlsmReach& reach, int accumulate,
             const shared::MlsmParams& params, const MlsmMap& map, ReceiverImage& receivers);

  private:
    using Lookup = runtime::Kernel<shared::MultiViewParams, shared::LookupParams,
                                   shared::MlsmParams, shared::MlsmLookupParams, int, Buffer<float>,
                                   Buffer<std::uint32_t>, Buffer<float>, Buffer<std::uint32_t>>;
    runtime::Device* device_;
    MlsmSettings settings_;
    Lookup lookup_, colour_;
};

}  // namespace penumbra::visibility
