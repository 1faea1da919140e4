// SPDX-License-Identifier: MIT
// The paper's own way to pairs of receivers and triangles: a grid whose pixels list both [4DR] 3.1.
#pragma once
#include "host/visibility/raster4d.h"
#include "runtime/scan.h"

namespace penumbra::visibility {

class Raster4dGrid {
  public:
    Raster4dGrid(const runtime::Program& frame, const runtime::Program& raster4d,
                 const Raster4dSettings& settings);
    /// Enqueues steps 2 to 5, a band of the grid's rows at a time.
    void run(const Inputs& inputs, const shared::Raster4dParams& params,
             const LightReceivers& receivers, const LightTriangles& triangles,
             const LightCells& cells, Visibility& visibility, Buffer<std::uint32_t>& masks);
    /// Waits. Where a list was too short it grows; where it may not, there will be more bands.
    bool grew();

  private:
    using U32 = std::uint32_t;
    using Params = shared::Raster4dParams;
    using GridParams = shared::Raster4dGridParams;
    /// Entries of all pixels of a band, one after the other.
    struct Lists {
        Buffer<U32> cursors;  ///< [pixel] before filling where its entries begin, then their end
        Buffer<U32> entries, total;
    };
    template <typename Assign>
    void assign(GridParams grid, Lists& lists, const Assign& launch);
    runtime::Device* device_;
    Raster4dSettings settings_;
    runtime::Scan scan_;
    runtime::Kernel<Params, Buffer<float>, Buffer<U32>, Buffer<U32>> extent_;
    runtime::Kernel<Params, GridParams, Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<U32>,
                    Buffer<U32>>
        assignReceivers_;
    runtime::Kernel<Params, GridParams, Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<U32>>
        assignTriangles_;
    runtime::Kernel<Buffer<U32>, Buffer<U32>> longest_;
    runtime::Kernel<Params, GridParams, Buffer<float>, Buffer<float>, Buffer<float>, Buffer<float>,
                    Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<U32>, Buffer<float>,
                    Buffer<float>, Buffer<int>, Buffer<U32>, Buffer<U32>, Buffer<shared::Draw>,
                    Buffer<shared::Material>, Buffer<float>, Buffer<U32>, Buffer<U32>, Buffer<U32>>
        masks_;
    runtime::Kernel<Params, shared::ReceiverParams, Buffer<float>, Buffer<float>, Buffer<U32>,
                    Buffer<float>, Buffer<float>, Buffer<int>, Buffer<U32>, Buffer<U32>,
                    Buffer<float>, Buffer<U32>>
        finish_;
    Buffer<U32> extentBuffer_, receiverMasks_, longestBuffer_;
    Lists receiverLists_, triangleLists_;
    std::uint64_t capacity_;
    int bands_ = 1;
};

}  // namespace penumbra::visibility
