// SPDX-License-Identifier: MIT
// Leaves out receivers that no caster can shadow.
#pragma once
#include "host/visibility/light_view.h"
#include "host/visibility/technique.h"
#include "kernels/shared/occupancy.h"

namespace penumbra::visibility {

/// Which parts of a light's central view hold casters. Kernels: kernels/visibility/occupancy.cl
class Occupancy {
  public:
    explicit Occupancy(const runtime::Program& multiView);
    /// Enqueues setting RECEIVER_W of `receivers` [RECEIVER_PLANES, stride] to 0 where all tests
    /// against maps of the view would pass.
    void skip(const Mesh& mesh, const LightView& view, int stride, Buffer<float>& receivers);

  private:
    using U32 = std::uint32_t;
    runtime::Device* device_;
    runtime::Kernel<shared::MultiViewParams, U32, Buffer<float>, Buffer<U32>, Buffer<U32>,
                    Buffer<shared::Draw>, Buffer<U32>, Buffer<shared::OccupancyRange>>
        mark_;
    runtime::Kernel<Buffer<U32>> sum_;
    runtime::Kernel<shared::MultiViewParams, int, Buffer<U32>, Buffer<shared::OccupancyRange>,
                    Buffer<float>>
        skip_;
    Buffer<U32> cells_;
    Buffer<shared::OccupancyRange> range_;
};

}  // namespace penumbra::visibility
