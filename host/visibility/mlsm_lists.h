// SPDX-License-Identifier: MIT
// The base level of a multi-layer shadow map: all fragments of each texel in order of depth.
#pragma once
#include <deque>

#include "host/gbuffer/raster.h"
#include "host/visibility/light_view.h"
#include "host/visibility/mlsm_settings.h"
#include "kernels/shared/mlsm.h"
#include "runtime/scan.h"

namespace penumbra::visibility {

using geometry::Mesh;
using runtime::Buffer;

/// Lists and fragments of all levels; layouts in kernels/shared/mlsm.h.
struct MlsmMap {
    Buffer<std::uint32_t> lists;
    Buffer<float> fragments;
    Buffer<std::uint32_t>* total = nullptr;  ///< fragments of this light, also those without room
};

class MlsmLists {
  public:
    MlsmLists(const runtime::Program& frame, const runtime::Program& mlsm,
              const MlsmSettings& settings);

    /// Enqueues the base level of a light's central view into map(). Sets params.capacity.
    /// Kernels: kernels/visibility/mlsm_lists.cl
    void run(const Mesh& mesh, const LightView& view, shared::MlsmParams& params,
             Buffer<shared::MultiViewCounters>& counters);
    /// Waits for the device; true if a list was too short and has grown: repeat the frame.
    bool grew();
    /// Fragments of all levels of the last frame's lights; call after grew().
    std::uint64_t takeFragments();
    /// Bytes that the first frame will allocate at the least.
    std::uint64_t frameBytes(const Mesh& mesh, std::uint64_t lists) const;
    MlsmMap& map() { return map_; }

  private:
    using U32 = std::uint32_t;
    void allocate(const shared::MlsmParams& params);
    void fillArray(const Mesh& mesh, const shared::RasterView& raster,
                   const shared::MlsmParams& params, Buffer<shared::MultiViewCounters>& counters);
    void fillLinked(const Mesh& mesh, const shared::RasterView& raster,
                    const shared::MlsmParams& params, Buffer<shared::MultiViewCounters>& counters);
    void scanCounts(const shared::MlsmParams& params);

    template <typename... Extra>
    using Kernels = gbuffer::RasterKernels<Buffer<shared::Material>, Buffer<float>, Buffer<U32>,
                                           Buffer<U32>, Extra...>;
    runtime::Device* device_;
    MlsmSettings settings_;
    gbuffer::TileList tiles_;
    runtime::Scan scan_;
    Kernels<Buffer<U32>, Buffer<shared::MultiViewCounters>> count_;
    Kernels<shared::MlsmParams, Buffer<U32>, Buffer<U32>, Buffer<float>> fill_;
    Kernels<shared::MlsmParams, Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<float>,
            Buffer<shared::MultiViewCounters>>
        link_;
    runtime::Kernel<shared::MlsmParams, Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<float>,
                    Buffer<float>>
        collect_;
    runtime::Kernel<shared::MlsmParams, Buffer<U32>, Buffer<float>, Buffer<U32>> sort_;
    MlsmMap map_;
    Buffer<U32> counts_, first_;             ///< [texel], [texel + 1]
    Buffer<U32> heads_, links_, nodeCount_;  ///< of linked lists
    Buffer<float> nodes_;                    ///< their fragments
    std::deque<Buffer<U32>> totals_;         ///< [light of the frame]
    std::size_t lightsBegun_ = 0;
    std::uint64_t capacity_ = 0, fragments_ = 0;
};

}  // namespace penumbra::visibility
