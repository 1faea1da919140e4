// SPDX-License-Identifier: MIT
// Warps points into depth maps [VWSS] 3.2.
#pragma once
#include "host/visibility/multi_view.h"
#include "host/visibility/points.h"

namespace penumbra::visibility {

/// How many maps a traversal of the points writes [VWSS] 3.2; all give the same maps bit for bit.
enum class Parallelism { automatic, serial, partial, full, owned };

class DepthWarp {
  public:
    DepthWarp(const runtime::Program& multiView, Parallelism parallelism, int viewsPerPass);

    /// Enqueues filling the batch's maps: maps32 where needsWideMaps(). `automatic` is owned on CPUs,
    /// full elsewhere.
    void run(const PointBuffers& points, const LightView& view, const Buffer<float>& samples,
             const MapBatch& batch, const Buffer<shared::MultiViewCounters>& counters);
    /// True if only 32-bit maps can be filled.
    bool needsWideMaps() const { return parallelism_ != Parallelism::owned; }
    /// Views per launch: 1, viewsPerPass, or all of a batch.
    int viewsPerLaunch(int batch) const;

  private:
    template <typename Maps>
    using Warp = runtime::Kernel<shared::MultiViewParams, shared::LookupParams, Buffer<float>,
                                 Buffer<std::uint16_t>, Buffer<std::uint32_t>, Buffer<float>, Maps,
                                 Buffer<shared::MultiViewCounters>>;
    runtime::Device* device_;
    Parallelism parallelism_;
    int viewsPerPass_;
    Warp<Buffer<std::uint32_t>> warp_, owned_;
    Warp<Buffer<std::uint16_t>> owned16_;
};

}  // namespace penumbra::visibility
