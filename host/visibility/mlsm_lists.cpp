// SPDX-License-Identifier: MIT
#include "host/visibility/mlsm_lists.h"

#include <algorithm>
#include <utility>

#include "runtime/error.h"
#include "runtime/profiler.h"

namespace penumbra::visibility {
namespace {

constexpr std::uint64_t kMostFragments = 1ULL << 28;  // kernels index their floats with 31 bits

std::uint64_t firstCapacity(int resolution) {
    return 2 * static_cast<std::uint64_t>(resolution) * static_cast<std::uint64_t>(resolution);
}

shared::RasterView rasterView(const LightView& view, Faces faces) {
    auto raster = view.central;
    raster.requireFlags = DRAW_CASTS;
    if (faces == Faces::automatic) {
        raster.cullFront = DRAW_CLOSED;
        // Between the faces of a closed mesh only the front hides the light
        raster.keepBoth = DRAW_BLEND | DRAW_MASK | DRAW_ENCLOSES;
    }
    if (faces == Faces::back) raster.cullFront = DRAW_ANY;
    if (faces == Faces::front) raster.cullBack = DRAW_ANY;
    return raster;
}

}  // namespace

MlsmLists::MlsmLists(const runtime::Program& frame, const runtime::Program& mlsm,
                     const MlsmSettings& settings)
    : device_(&mlsm.device()),
      settings_(settings),
      tiles_(mlsm.device()),
      scan_(frame),
      count_(mlsm, "mlsm_count"),
      fill_(mlsm, "mlsm_fill"),
      link_(mlsm, "mlsm_link"),
      collect_(mlsm, "mlsm_collect"),
      sort_(mlsm, "mlsm_sort"),
      nodeCount_(*device_, "list nodes", 1),
      capacity_(std::min(firstCapacity(settings.resolution), device_->faults().firstCapacity)) {}

void MlsmLists::allocate(const shared::MlsmParams& params) {
    const auto values = static_cast<std::uint64_t>(MLSM_VALUES(params.channels));
    const auto texels = static_cast<std::uint64_t>(params.size[0]) * params.size[0];
    const int last = params.levels - 1;
    const auto lists = static_cast<std::uint64_t>(params.firstList[last]) +
                       static_cast<std::uint64_t>(params.size[last]) * params.size[last];
    counts_.grow(*device_, "fragment counts", texels + 1);
    first_.grow(*device_, "first fragments", texels + 1);
    map_.lists.grow(*device_, "fragment lists", MLSM_LIST * lists);
    map_.fragments.grow(*device_, "fragments", values * capacity_);
    if (settings_.build != ListBuild::list) return;
    heads_.grow(*device_, "list heads", texels);
    links_.grow(*device_, "list links", capacity_);
    nodes_.grow(*device_, "list nodes", values * capacity_);
}

void MlsmLists::scanCounts(const shared::MlsmParams& params) {
    device_->profiler().beginStage("fragment scan");
    const auto count = static_cast<U32>(params.resolution * params.resolution) + 1;
    first_.copyFrom(counts_, count);
    scan_.run(first_, count, *map_.total);
}

void MlsmLists::fillArray(const Mesh& mesh, const shared::RasterView& raster,
                          const shared::MlsmParams& params,
                          Buffer<shared::MultiViewCounters>& counters) {
    count_.launch(raster, mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours, mesh.texels,
                  counts_, counters);
    scanCounts(params);
    device_->profiler().beginStage("fragment collecting");
    tiles_.clear();
    fill_.launch(raster, mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours, mesh.texels, params,
                 first_, counts_, map_.fragments);
}

void MlsmLists::fillLinked(const Mesh& mesh, const shared::RasterView& raster,
                           const shared::MlsmParams& params,
                           Buffer<shared::MultiViewCounters>& counters) {
    heads_.fill(0);
    nodeCount_.fill(0);
    link_.launch(raster, mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours, mesh.texels, params,
                 counts_, heads_, nodeCount_, links_, nodes_, counters);
    scanCounts(params);
    device_->profiler().beginStage("fragment collecting");
    const auto texels = static_cast<std::uint64_t>(params.size[0]) * params.size[0];
    collect_.launch({texels}, {64}, params, first_, heads_, links_, nodes_, map_.fragments);
}

void MlsmLists::run(const Mesh& mesh, const LightView& view, shared::MlsmParams& params,
                    Buffer<shared::MultiViewCounters>& counters) {
    params.capacity = static_cast<U32>(capacity_);
    allocate(params);
    if (lightsBegun_ == totals_.size()) totals_.emplace_back(*device_, "fragment total", 1);
    map_.total = &totals_[lightsBegun_++];
    const auto raster = rasterView(view, settings_.faces);
    device_->profiler().beginStage("fragment counting");
    counts_.fill(0);
    tiles_.clear();
    if (settings_.build == ListBuild::list)
        fillLinked(mesh, raster, params, counters);
    else
        fillArray(mesh, raster, params, counters);
    device_->profiler().beginStage("fragment sorting");
    const auto texels = static_cast<std::uint64_t>(params.size[0]) * params.size[0];
    sort_.launch({texels}, {64}, params, first_, map_.fragments, map_.lists);
}

bool MlsmLists::grew() {
    std::uint64_t most = 0;
    fragments_ = 0;
    for (std::size_t i = 0; i < lightsBegun_; ++i) {
        const std::uint64_t total = totals_[i].download()[0];
        most = std::max(most, total);
        fragments_ += total;
    }
    lightsBegun_ = 0;
    const bool tiles = tiles_.grew();
    if (most <= capacity_) return tiles;
    // Where the base level itself did not fit, those above it are not counted yet
    capacity_ = most + most / 2;
    if (capacity_ > kMostFragments)
        throw Error(fmt::format("out of memory: {} fragments, at most {} fit; use a smaller "
                                "mlsm.resolution or fewer mlsm.layers",
                                capacity_, kMostFragments),
                    ExitCode::outOfMemory);
    return true;
}

std::uint64_t MlsmLists::takeFragments() {
    return std::exchange(fragments_, 0);
}

std::uint64_t MlsmLists::frameBytes(const Mesh& mesh, std::uint64_t lists) const {
    const auto values = static_cast<std::uint64_t>(MLSM_VALUES(mesh.hasBlend ? 3 : 1));
    const auto texels = firstCapacity(settings_.resolution) / 2;
    const bool linked = settings_.build == ListBuild::list;
    return sizeof(U32) * (2 * texels + 2 + MLSM_LIST * lists + values * capacity_) +
           (linked ? sizeof(U32) * (texels + (1 + values) * capacity_) : 0);
}

}  // namespace penumbra::visibility
