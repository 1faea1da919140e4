// SPDX-License-Identifier: MIT
// The A-buffer pass: what the camera sees before the opaque surface of a pixel, in depth order.
#pragma once
#include "host/gbuffer/raster.h"
#include "kernels/shared/abuffer.h"
#include "runtime/scan.h"

namespace penumbra::gbuffer {

/// Lists of blended fragments, one pixel's after the other's; see kernels/shared/abuffer.h.
struct FragmentLists {
    int pixels = 0;              ///< of the image
    std::uint32_t capacity = 0;  ///< fragments
    Buffer<std::uint32_t> ends, fragments, owners;
    Buffer<float> coverage;
};

/// What the lists of a frame held.
struct FragmentCounts {
    std::uint32_t fragments = 0;
    std::uint32_t layers = 0;  ///< of the longest list
};

class ABuffer {
  public:
    /// Width and height of the image. The lists hold nothing until the first run.
    ABuffer(const runtime::Program& frame, int width, int height);

    /// Enqueues building the lists of all blended surfaces of the mesh. `opaque`: depth bits of the
    /// nearest opaque surface, the last of every `depthStride` words. Kernels:
    /// kernels/gbuffer/abuffer.cl. The first run allocates a row of fragments.
    void run(shared::RasterView view, const Mesh& mesh, const Buffer<std::uint32_t>& opaque,
             int depthStride);
    /// Waits for the device; true if the lists, or those of the rasteriser, were too short and have
    /// grown: repeat the frame. Throws Error (exit code 4) where no more fragments can be numbered.
    bool grew();
    const FragmentLists& lists() const { return lists_; }
    /// Rows of the image's width that hold an entry for each fragment.
    int rows() const { return rows_; }
    /// Of the last frame, as of grew().
    FragmentCounts counts() const { return counts_; }

  private:
    using U32 = std::uint32_t;
    void allocate(int rows);

    runtime::Device* device_;
    int width_;
    TileList tiles_;
    runtime::Scan scan_;
    template <typename... Extra>
    using Kernels = RasterKernels<Buffer<shared::Material>, Buffer<float>, Buffer<U32>, Buffer<U32>,
                                  shared::ABufferParams, Buffer<U32>, Buffer<U32>, Extra...>;
    Kernels<> count_;
    Kernels<Buffer<U32>, Buffer<U32>> fill_;
    runtime::Kernel<shared::ABufferParams, Buffer<float>, Buffer<U32>, Buffer<U32>,
                    Buffer<shared::Draw>, Buffer<U32>, Buffer<U32>, Buffer<U32>>
        sort_;
    Buffer<U32> total_, layers_;
    FragmentLists lists_;
    int rows_ = 0;
    FragmentCounts counts_;
};

}  // namespace penumbra::gbuffer
