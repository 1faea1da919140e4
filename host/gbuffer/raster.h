// SPDX-License-Identifier: MIT
// Launches of the rasteriser core (kernels/lib/raster.inl), whatever its fragment action.
#pragma once
#include <deque>
#include <string>

#include "host/geometry/geometry.h"
#include "kernels/shared/raster.h"

namespace penumbra::gbuffer {

using geometry::Mesh;
using runtime::Buffer;

/// Tiles of large triangles: appended on the device, grown by the host when they did not fit.
class TileList {
  public:
    explicit TileList(runtime::Device& device);
    /// Enqueues emptying the list. Each use in a frame has its own counter, so that none is missed.
    void clear();
    /// Waits for the device; true if the list was too short in any use since the last call. It then
    /// has grown: repeat the frame.
    bool grew();
    std::uint32_t capacity() const { return static_cast<std::uint32_t>(tiles_.count()); }
    Buffer<std::uint32_t>& count() { return counts_[used_ - 1]; }
    Buffer<shared::RasterTile>& tiles() { return tiles_; }

  private:
    runtime::Device* device_;
    std::deque<Buffer<std::uint32_t>> counts_;
    std::size_t used_ = 0;
    Buffer<shared::RasterTile> tiles_;
};

/// The two kernels of one paste of the core; Extra... are the types of RASTER_PARAMETERS.
template <typename... Extra>
class RasterKernels {
  public:
    /// `name` and `name`_large.
    RasterKernels(const runtime::Program& program, const std::string& name)
        : info_(&program.device().info()),
          small_(program, name),
          large_(program, name + "_large") {}

    /// Enqueues both for all triangles of the mesh; `tiles` must be cleared before.
    void launch(shared::RasterView view, const Mesh& mesh, TileList& tiles, const Extra&... extra) {
        view.triangleCount = static_cast<int>(mesh.triangleCount);
        view.tileCapacity = tiles.capacity();
        const std::uint64_t chunk = info_->isCpu ? 64 : 1;  // RASTER_CHUNK
        const std::uint64_t group = info_->isCpu ? 1 : 64;
        const auto groups = static_cast<std::uint64_t>(info_->computeUnits) * 16;
        small_.launch({(mesh.triangleCount + chunk - 1) / chunk}, {group}, view, mesh.positions,
                      mesh.indices, mesh.triangleDraw, mesh.draws, tiles.count(), tiles.tiles(),
                      extra...);
        const std::uint64_t columns = info_->isCpu ? 1 : RASTER_TILE;
        large_.launch({groups * columns}, {columns}, view, mesh.positions, mesh.indices,
                      mesh.triangleDraw, mesh.draws, tiles.count(), tiles.tiles(), extra...);
    }

  private:
    using Core = runtime::Kernel<shared::RasterView, Buffer<float>, Buffer<std::uint32_t>,
                                 Buffer<std::uint32_t>, Buffer<shared::Draw>, Buffer<std::uint32_t>,
                                 Buffer<shared::RasterTile>, Extra...>;
    const runtime::DeviceInfo* info_;
    Core small_, large_;
};

}  // namespace penumbra::gbuffer
