// SPDX-License-Identifier: MIT
#include "host/visibility/points.h"

#include <algorithm>

#include "runtime/error.h"

namespace penumbra::visibility {

constexpr std::uint64_t kFirstCapacity = 1 << 18;

Points::Points(const runtime::Program& multiView, Cull cull, Precision precision)
    : device_(&multiView.device()),
      cull_(cull),
      precision_(precision),
      tiles_(multiView.device()),
      points_(multiView, "points"),
      direct_(multiView, "points_direct") {
    buffers_.points32 = runtime::Buffer<float>(*device_, "points", 1);
    buffers_.points16 = runtime::Buffer<std::uint16_t>(*device_, "points", 1);
    buffers_.keys = runtime::Buffer<std::uint32_t>(*device_, "point opacities", 1);
}

void Points::adapt(const geometry::Mesh& mesh, LightView& view) const {
    view.params.precision = static_cast<int>(precision_);
    view.params.alphaKeys = mesh.hasBlend ? 1 : 0;
    view.params.pointCapacity = capacity_;
}

std::uint64_t Points::plannedBytes(Precision precision) {
    return 3 * kFirstCapacity * (precision == Precision::single ? 4 : 2);
}

bool Points::grow(std::uint64_t count) {
    if (count <= capacity_ && capacity_ > 0) return false;
    const auto first = std::min(kFirstCapacity, device_->faults().firstCapacity);
    const std::uint64_t wanted = std::max(first, (count + count / 4 + 15) / 16 * 16);
    if (wanted > 1ULL << 30)
        throw Error(
            fmt::format("out of memory: {} points; use a smaller resolution or density", count),
            ExitCode::outOfMemory);
    if (precision_ == Precision::single)
        buffers_.points32.grow(*device_, "points", 3 * wanted);
    else
        buffers_.points16.grow(*device_, "points", 3 * wanted);
    capacity_ = static_cast<std::uint32_t>(wanted);
    return true;
}

shared::RasterView Points::rasterView(const LightView& view) const {
    auto raster = view.enlarged;
    selectCasters(cull_, raster);
    return raster;
}

void Points::run(const geometry::Mesh& mesh, const LightView& view,
                 runtime::Buffer<shared::MultiViewCounters>& counters) {
    if (view.params.alphaKeys) buffers_.keys.grow(*device_, "point opacities", capacity_);
    tiles_.clear();
    points_.launch(rasterView(view), mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours,
                   mesh.texels, view.params, buffers_.points32, buffers_.points16, buffers_.keys,
                   counters);
}

void Points::runDirect(const geometry::Mesh& mesh, const LightView& view,
                       const shared::LookupParams& views, const runtime::Buffer<float>& samples,
                       runtime::Buffer<std::uint32_t>& maps,
                       runtime::Buffer<shared::MultiViewCounters>& counters) {
    tiles_.clear();
    direct_.launch(rasterView(view), mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours,
                   mesh.texels, view.params, views, samples, maps, counters);
}

}  // namespace penumbra::visibility
