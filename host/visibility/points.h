// SPDX-License-Identifier: MIT
// Points of the casters as the enlarged view of a light sees them, and depth maps straight from
// them.
#pragma once
#include "host/gbuffer/raster.h"
#include "host/visibility/cull.h"
#include "host/visibility/light_view.h"

namespace penumbra::visibility {

enum class Precision { single, half, fixed };

/// The point buffers; layouts in kernels/visibility/points.cl. One element where a form is not in
/// use.
struct PointBuffers {
    runtime::Buffer<float> points32;
    runtime::Buffer<std::uint16_t> points16;
    runtime::Buffer<std::uint32_t> keys;
};

class Points {
  public:
    Points(const runtime::Program& multiView, Cull cull, Precision precision);

    /// Sets pointCapacity, precision and alphaKeys of view.params. Reserves no memory.
    void adapt(const geometry::Mesh& mesh, LightView& view) const;
    /// Enqueues point generation [VWSS] 3.1 into buffers(); counters receive the number of points,
    /// also of those that found no room.
    void run(const geometry::Mesh& mesh, const LightView& view,
             runtime::Buffer<shared::MultiViewCounters>& counters);
    /// Enqueues splatting fragments as they are rasterised ([VWSS] 3, unbuffered) into 32-bit maps.
    void runDirect(const geometry::Mesh& mesh, const LightView& view,
                   const shared::LookupParams& views, const runtime::Buffer<float>& samples,
                   runtime::Buffer<std::uint32_t>& maps,
                   runtime::Buffer<shared::MultiViewCounters>& counters);
    /// Makes room for `count` points. Returns false if there was enough.
    bool grow(std::uint64_t count);
    /// Bytes of the first capacity.
    static std::uint64_t plannedBytes(Precision precision);
    /// Bytes of the opacities that points carry where anything is blended.
    std::uint64_t keyBytes(const geometry::Mesh& mesh) const {
        return mesh.hasBlend ? std::uint64_t{capacity_} * sizeof(std::uint32_t) : 0;
    }
    bool grewTiles() { return tiles_.grew(); }
    const PointBuffers& buffers() const { return buffers_; }

  private:
    shared::RasterView rasterView(const LightView& view) const;

    template <typename... Extra>
    using Kernels =
        gbuffer::RasterKernels<runtime::Buffer<shared::Material>, runtime::Buffer<float>,
                               runtime::Buffer<std::uint32_t>, runtime::Buffer<std::uint32_t>,
                               shared::MultiViewParams, Extra...>;
    runtime::Device* device_;
    Cull cull_;
    Precision precision_;
    gbuffer::TileList tiles_;
    Kernels<runtime::Buffer<float>, runtime::Buffer<std::uint16_t>, runtime::Buffer<std::uint32_t>,
            runtime::Buffer<shared::MultiViewCounters>>
        points_;
    Kernels<shared::LookupParams, runtime::Buffer<float>, runtime::Buffer<std::uint32_t>,
            runtime::Buffer<shared::MultiViewCounters>>
        direct_;
    std::uint32_t capacity_ = 0;
    PointBuffers buffers_;
};

}  // namespace penumbra::visibility
