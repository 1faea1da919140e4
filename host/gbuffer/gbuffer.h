// SPDX-License-Identifier: MIT
// The G-buffer pass: what the camera sees at each pixel.
#pragma once
#include <memory>

#include "host/gbuffer/abuffer.h"
#include "host/scene/camera.h"
#include "kernels/shared/gbuffer.h"

namespace penumbra::gbuffer {

/// Planes of surface attributes; see kernels/shared/gbuffer.h. Blended fragments are pixels too, in
/// further rows below the image, so that whatever lights pixels lights them as well.
struct GBuffer {
    int width = 0, height = 0;  ///< of the image
    int fragmentRows = 0;       ///< below the image
    int planeStride = 0;        ///< floats between planes: see gbufferStride()
    Buffer<float> planes;
    const FragmentLists* blended = nullptr;  ///< null where the scene has no blended surfaces
    int rows() const { return height + fragmentRows; }
};

class GBufferPass {
  public:
    /// Width and height in pixels, at most RASTER_MAX_SIZE. `allowAtomics64` false takes the path
    /// of devices without them; both give the same image.
    GBufferPass(const runtime::Program& frame, int width, int height, bool allowAtomics64 = true);

    /// Enqueues rasterising the mesh. `centre` is what the world was re-based to. Blended surfaces
    /// become entries of their own; they allocate when the mesh first has any, and after they grew.
    const GBuffer& run(const Mesh& mesh, const scene::CameraFrame& camera,
                       const glm::dvec3& centre);
    /// Waits for the device; true if a list was too short: repeat the frame, with images of the
    /// result's new number of rows.
    bool grew();
    const GBuffer& result() const { return gbuffer_; }
    /// Blended fragments of the last frame, as of grew().
    FragmentCounts fragmentCounts() const { return abuffer_.counts(); }
    bool usesAtomics64() const { return wide_ != nullptr; }
    static std::uint64_t plannedBytes(int width, int height);

  private:
    template <typename... Extra>
    using Kernels = RasterKernels<Buffer<shared::Material>, Buffer<float>, Buffer<std::uint32_t>,
                                  Buffer<std::uint32_t>, Extra...>;
    void makeWide();
    void rasterise(const shared::RasterView& view, const Mesh& mesh);
    void fitRows();

    runtime::Device* device_;
    TileList tiles_;
    Kernels<Buffer<std::uint32_t>> depth_;
    Kernels<Buffer<std::uint32_t>, Buffer<std::uint32_t>> id_;
    std::unique_ptr<Kernels<Buffer<std::uint32_t>>>
        wide_;  ///< null: two passes with 32-bit atomics
    runtime::Kernel<shared::GBufferParams, shared::RasterView, Buffer<float>, Buffer<float>,
                    Buffer<float>, Buffer<float>, Buffer<std::uint32_t>, Buffer<std::uint32_t>,
                    Buffer<shared::Draw>, Buffer<shared::Material>, Buffer<float>,
                    Buffer<std::uint32_t>, Buffer<std::uint32_t>, Buffer<std::uint32_t>,
                    Buffer<std::uint32_t>, Buffer<std::uint32_t>, Buffer<std::uint32_t>,
                    Buffer<float>, Buffer<float>>
        resolve_;
    ABuffer abuffer_;
    Buffer<std::uint32_t> depthBits_;   ///< [h, w]; only without 64-bit atomics
    Buffer<std::uint32_t> visibility_;  ///< [h, w] ~triangle, or [h, w, 2] with 64-bit atomics
    GBuffer gbuffer_;
};

}  // namespace penumbra::gbuffer
