// SPDX-License-Identifier: MIT
#include "host/visibility/map_raster.h"

#include <algorithm>

#include "runtime/profiler.h"

namespace penumbra::visibility {
namespace {

constexpr std::uint64_t kShareChunk = 64;  // MAP_SHARE_CHUNK
constexpr std::uint64_t kMostLanes = 16;

}  // namespace

MapRaster::MapRaster(const runtime::Program& program, const MapRasterSettings& settings)
    : device_(&program.device()),
      settings_(settings),
      ownsMaps_(settings.form == MapForm::full && device_->info().isCpu),
      tiles_(program.device()),
      raster_(program, "map_raster"),
      vertices_(program, "map_raster_vertices"),
      share_(program, "map_raster_share"),
      owned32_(program, "map_raster_owned"),
      owned16_(program, "map_raster_owned16") {}

shared::RasterView MapRaster::rasterView(const LightView& view) const {
    auto raster = view.central;
    selectCasters(settings_.cull, raster);
    if (!settings_.castersOnly) raster.requireFlags = DRAW_RECEIVES;
    raster.triangleCount = static_cast<int>(mesh_->triangleCount);
    raster.conservative = settings_.coverage == Coverage::conservative ? 1 : 0;
    return raster;
}

void MapRaster::begin(const Inputs& inputs, LightView& view, Buffer<float>& samples,
                      Buffer<shared::MultiViewCounters>&) {
    mesh_ = &inputs.mesh;
    view_ = &view;
    samples_ = &samples;
    view.params.alphaKeys = mesh_->hasBlend ? 1 : 0;
    params_ = {};
    params_.vertexCount = static_cast<int>(mesh_->vertexCount);
    params_.vertexStride = (params_.vertexCount + 15) / 16 * 16;
    params_.conservative = settings_.coverage == Coverage::conservative ? 1 : 0;
    params_.biasConstant = settings_.biasConstant;
    params_.biasSlope = settings_.biasSlope;
    projected_.grow(*device_, "projected vertices",
                    3 * static_cast<std::uint64_t>(params_.vertexStride) + 1);
    if (lightsBegun_ == counts_.size()) counts_.emplace_back(*device_, "triangle counts", 1);
    counts_[lightsBegun_++].fill({});
    device_->profiler().beginStage("depth maps");
    if (settings_.form == MapForm::textbook) {
        drawnTriangles_ += mesh_->casterTriangleCount;
        return;
    }
    project(0, 0);
    if (ownsMaps_)
        share();
    else
        drawnTriangles_ += mesh_->casterTriangleCount;
}

std::uint64_t MapRaster::frameBytes(const Mesh& mesh) const {
    const std::uint64_t vertices = 3 * sizeof(float) * (std::uint64_t{mesh.vertexCount} + 16);
    const std::uint64_t triangles = (MAP_TRIANGLE_PLANES + 2) * sizeof(float) *
                                    (std::uint64_t{mesh.triangleCount} + 2 * kMostLanes);
    return vertices + (ownsMaps_ ? triangles : 0);
}

void MapRaster::project(float kx, float ky) {
    auto params = params_;
    params.kx = kx;
    params.ky = ky;
    vertices_.launch({mesh_->vertexCount}, {64}, view_->params, params, mesh_->positions,
                     projected_);
}

/// Lists the triangles that some view may show; what the lists hold is counted on the device.
void MapRaster::share() {
    const std::uint64_t capacity =
        (static_cast<std::uint64_t>(mesh_->triangleCount) + 2 * kMostLanes) / 16 * 16;
    params_.capacity = static_cast<int>(capacity);
    triangles_.grow(*device_, "triangles of all views", MAP_TRIANGLE_PLANES * capacity);
    flags_.grow(*device_, "triangle flags", capacity);
    specials_.grow(*device_, "special triangles", capacity);
    share_.launch({(mesh_->triangleCount + kShareChunk - 1) / kShareChunk}, {1}, view_->params,
                  rasterView(*view_), params_, projected_, mesh_->indices, mesh_->triangleDraw,
                  mesh_->draws, triangles_, flags_, specials_, counts_[lightsBegun_ - 1]);
}

void MapRaster::fillOwned(const MapBatch& batch) {
    const runtime::Range items{static_cast<std::uint64_t>(batch.viewCount)};
    const auto launch = [&](auto& kernel, auto& maps) {
        kernel.launch(items, {1}, rasterView(*view_), view_->params, params_, mesh_->positions,
                      mesh_->indices, mesh_->triangleDraw, mesh_->draws, mesh_->materials,
                      mesh_->uvs, mesh_->colours, mesh_->texels, projected_, triangles_, flags_,
                      specials_, counts_[lightsBegun_ - 1], *samples_, maps);
    };
    if (batch.maps16)
        launch(owned16_, *batch.maps16);
    else
        launch(owned32_, *batch.maps32);
}

void MapRaster::fill(const MapBatch& batch) {
    params_.firstView = batch.firstView;
    params_.viewCount = batch.viewCount;
    if (ownsMaps_) {
        fillOwned(batch);
        return;
    }
    batch.maps32->fill(0, static_cast<std::uint64_t>(view_->params.mapStride) *
                              static_cast<std::uint64_t>(batch.viewCount));
    for (int i = 0; i < batch.viewCount; ++i) {
        auto params = params_;
        params.view = batch.firstView + i;
        params.kx = view_->samples[2 * static_cast<std::size_t>(params.view)];
        params.ky = view_->samples[2 * static_cast<std::size_t>(params.view) + 1];
        if (settings_.form == MapForm::textbook) {
            project(params.kx, params.ky);
        } else {
            params.shiftX = params.kx;
            params.shiftY = params.ky;
        }
        tiles_.clear();
        raster_.launch(rasterView(*view_), *mesh_, tiles_, mesh_->materials, mesh_->uvs,
                       mesh_->colours, mesh_->texels, view_->params, params, projected_,
                       *batch.maps32);
    }
}

std::uint64_t MapRaster::takeTriangles() {
    std::uint64_t triangles = drawnTriangles_;
    for (std::size_t i = 0; i < lightsBegun_; ++i) {
        const auto counts = counts_[i].download()[0];
        triangles += counts.plain + counts.special;
    }
    drawnTriangles_ = 0;
    lightsBegun_ = 0;
    return triangles;
}

}  // namespace penumbra::visibility
