// SPDX-License-Identifier: MIT
// Triangles straight into the depth maps of a light's views [VWSS] 2.1.
#pragma once
#include "host/gbuffer/raster.h"
#include "host/visibility/cull.h"
#include "host/visibility/multi_view.h"
#include "kernels/shared/map_raster.h"

namespace penumbra::visibility {

/// full: vertices are projected and triangles culled once for all views, and on CPUs a map belongs
/// to one work-item; textbook: each view transforms every vertex and draws every triangle with
/// atomics. Both give the same maps bit for bit.
enum class MapForm { full, textbook };
/// Texels that a triangle covers [VWSS] figure 6: those whose centre it holds, or all it touches.
enum class Coverage { standard, conservative };

struct MapRasterSettings {
    MapForm form = MapForm::full;
    Coverage coverage = Coverage::standard;
    Cull cull = Cull::automatic;
    bool castersOnly = true;  ///< false: everything that receives shadows
    float biasConstant = 0;   ///< of depth (near / z), pushing it away from the light
    float biasSlope = 0;      ///< times the larger of the depth's steps per texel
};

/// The source of depth maps of mvr and mvss, and of the one map of pcss and essm. Kernels:
/// kernels/visibility/map_raster.cl
class MapRaster : public MapSource {
  public:
    MapRaster(const runtime::Program& program, const MapRasterSettings& settings);

    void begin(const Inputs& inputs, LightView& view, Buffer<float>& samples,
               Buffer<shared::MultiViewCounters>& counters) override;
    void fill(const MapBatch& batch) override;
    bool needsWideMaps() const override { return !ownsMaps_; }
    bool grew() override { return tiles_.grew(); }
    /// Bytes of projected vertices and shared triangles, which the first frame allocates.
    std::uint64_t frameBytes(const Mesh& mesh) const;
    /// Triangles that the views of the frame's lights drew, per map (waits).
    std::uint64_t takeTriangles();

  private:
    using U32 = std::uint32_t;
    shared::RasterView rasterView(const LightView& view) const;
    void project(float kx, float ky);
    void share();
    void fillOwned(const MapBatch& batch);

    template <typename... Extra>
    using Kernels =
        gbuffer::RasterKernels<Buffer<shared::Material>, Buffer<float>, Buffer<U32>, Buffer<U32>,
                               shared::MultiViewParams, shared::MapRasterParams, Extra...>;
    template <typename Texel>
    using Owned =
        runtime::Kernel<shared::RasterView, shared::MultiViewParams, shared::MapRasterParams,
                        Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<shared::Draw>,
                        Buffer<shared::Material>, Buffer<float>, Buffer<U32>, Buffer<U32>,
                        Buffer<float>, Buffer<float>, Buffer<U32>, Buffer<U32>,
                        Buffer<shared::MapRasterCounts>, Buffer<float>, Buffer<Texel>>;
    runtime::Device* device_;
    MapRasterSettings settings_;
    bool ownsMaps_;  ///< a work-item per map, without atomics
    gbuffer::TileList tiles_;
    Kernels<Buffer<float>, Buffer<U32>> raster_;
    runtime::Kernel<shared::MultiViewParams, shared::MapRasterParams, Buffer<float>, Buffer<float>>
        vertices_;
    runtime::Kernel<shared::MultiViewParams, shared::RasterView, shared::MapRasterParams,
                    Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<shared::Draw>, Buffer<float>,
                    Buffer<U32>, Buffer<U32>, Buffer<shared::MapRasterCounts>>
        share_;
    Owned<U32> owned32_;
    Owned<std::uint16_t> owned16_;
    Buffer<float> projected_;                              ///< [3, vertex]
    Buffer<float> triangles_;                              ///< [MAP_TRIANGLE_PLANES, triangle]
    Buffer<U32> flags_, specials_;                         ///< [triangle]
    std::vector<Buffer<shared::MapRasterCounts>> counts_;  ///< [light of the frame]
    std::size_t lightsBegun_ = 0;
    std::uint64_t drawnTriangles_ = 0;
    const Mesh* mesh_ = nullptr;
    LightView* view_ = nullptr;
    Buffer<float>* samples_ = nullptr;
    shared::MapRasterParams params_{};
};

}  // namespace penumbra::visibility
