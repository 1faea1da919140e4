// SPDX-License-Identifier: MIT
#include "host/visibility/raster4d_grid.h"

#include <algorithm>

#include "runtime/profiler.h"

namespace penumbra::visibility {

constexpr std::uint64_t kFirstCapacity = 1 << 20;

Raster4dGrid::Raster4dGrid(const runtime::Program& frame, const runtime::Program& raster4d,
                           const Raster4dSettings& settings)
    : device_(&frame.device()),
      settings_(settings),
      scan_(frame),
      extent_(raster4d, "raster4d_grid_extent"),
      assignReceivers_(raster4d, "raster4d_grid_receivers"),
      assignTriangles_(raster4d, "raster4d_grid_triangles"),
      longest_(raster4d, "raster4d_grid_longest"),
      masks_(raster4d, "raster4d_grid_masks"),
      finish_(raster4d, "raster4d_grid_finish"),
      extentBuffer_(*device_, "extent of the grid", 4),
      longestBuffer_(*device_, "longest list", 1),
      capacity_(std::min(kFirstCapacity, device_->faults().firstCapacity)) {
    for (auto* lists : {&receiverLists_, &triangleLists_})
        lists->total = Buffer<U32>(*device_, "entries of the grid", 1);
    longestBuffer_.fill(0);
}

/// Counts, scans and fills the lists of a band.
template <typename Assign>
void Raster4dGrid::assign(GridParams grid, Lists& lists, const Assign& launch) {
    const auto pixels = static_cast<U32>(grid.size * grid.rowCount);
    lists.cursors.fill(0, pixels);
    launch(grid);
    scan_.run(lists.cursors, pixels, lists.total);
    longest_.launch({1}, {1}, lists.total, longestBuffer_);
    grid.fill = 1;
    launch(grid);
}

void Raster4dGrid::run(const Inputs& inputs, const Params& params, const LightReceivers& receivers,
                       const LightTriangles& triangles, const LightCells& cells,
                       Visibility& visibility, Buffer<U32>& masks) {
    const auto& mesh = inputs.mesh;
    const auto count = static_cast<std::uint64_t>(params.planeStride);
    const auto words = count * static_cast<std::uint64_t>(params.words * params.rows);
    const int rows = (settings_.grid + bands_ - 1) / bands_;
    const auto pixels =
        static_cast<std::uint64_t>(settings_.grid) * static_cast<std::uint64_t>(rows);
    receiverMasks_.grow(*device_, "receivers' masks", words);
    receiverMasks_.fill(0, words);
    for (auto* lists : {&receiverLists_, &triangleLists_}) {
        lists->cursors.grow(*device_, "pixels of the grid", pixels);
        lists->entries.grow(*device_, "lists of the grid", capacity_);
    }
    extentBuffer_.fill(0);
    extent_.launch({(count + 63) / 64}, {1}, params, receivers.planes(), receivers.count(),
                   extentBuffer_);
    const runtime::Range slots{static_cast<std::uint64_t>(params.nodeCount[0]) * R4_WIDTH};
    for (int row = 0; row < settings_.grid; row += rows) {
        device_->profiler().beginStage("assignment");
        const GridParams grid{settings_.grid,
                              row,
                              std::min(rows, settings_.grid - row),
                              settings_.onePixel ? 1 : 0,
                              settings_.reject ? 1 : 0,
                              0,
                              static_cast<U32>(capacity_),
                              0};
        assign(grid, receiverLists_, [&](const GridParams& g) {
            assignReceivers_.launch({count}, {64}, params, g, receivers.planes(), receivers.count(),
                                    extentBuffer_, receiverLists_.cursors, receiverLists_.entries);
        });
        assign(grid, triangleLists_, [&](const GridParams& g) {
            assignTriangles_.launch(slots, {64}, params, g, triangles.bounds(0), extentBuffer_,
                                    triangleLists_.cursors, triangleLists_.entries);
        });
        device_->profiler().beginStage("masks");
        masks_.launch({static_cast<std::uint64_t>(grid.size * grid.rowCount)}, {1}, params, grid,
                      receivers.planes(), triangles.bounds(0), triangles.corners(),
                      triangles.world(), triangles.order(), receiverLists_.cursors,
                      receiverLists_.entries, triangleLists_.cursors, triangleLists_.entries,
                      cells.x, cells.y, cells.sample, mesh.indices, mesh.triangleDraw, mesh.draws,
                      mesh.materials, mesh.uvs, mesh.colours, mesh.texels, receiverMasks_);
    }
    finish_.launch({count}, {64}, params, receivers.image(), inputs.gbuffer.planes,
                   receivers.planes(), receivers.count(), cells.x, cells.y, cells.sample,
                   cells.empty, receiverMasks_, visibility.planes, masks);
}

bool Raster4dGrid::grew() {
    const std::uint64_t longest = longestBuffer_.download()[0];
    longestBuffer_.fill(0);
    if (longest <= capacity_) return false;
    // Both lists, and half of the memory left for everything else
    const auto limit = std::min(device_->info().maxAllocBytes, device_->memoryLimitBytes() / 4);
    if (longest * sizeof(U32) <= limit) {
        capacity_ = longest + longest / 4;
        return true;
    }
    require(bands_ < settings_.grid,
            "raster4d.method grid: a row of the grid lists {} pairs, at most {} fit; use a smaller "
            "raster4d.grid, or raster4d.method=bins",
            longest, limit / sizeof(U32));
    bands_ = std::min(2 * bands_, settings_.grid);
    return true;
}

}  // namespace penumbra::visibility
