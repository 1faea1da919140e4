// SPDX-License-Identifier: MIT
#include "host/gbuffer/gbuffer.h"

#include <algorithm>

#include "runtime/error.h"
#include "runtime/profiler.h"

namespace penumbra::gbuffer {
namespace {

int paddedPixels(int width, int height) {
    return shared::gbufferStride(width * height);
}

shared::float4 narrow(const glm::dvec3& v, double w) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(w)};
}

shared::GBufferParams paramsFor(const scene::CameraFrame& camera, const glm::dvec3& centre) {
    shared::GBufferParams params{};
    const glm::dvec3 eye = glm::dvec3(camera.worldFromCamera[3]) - centre;
    const glm::dvec3 backwards(camera.worldFromCamera[2]);
    params.eye = camera.orthographic ? narrow(backwards, 0) : narrow(eye, 1);
    const glm::dvec4 row = scene::depthRow(camera, centre);
    params.rowDepth = narrow(glm::dvec3(row), row.w);
    return params;
}

}  // namespace

GBufferPass::GBufferPass(const runtime::Program& frame, int width, int height, bool allowAtomics64)
    : device_(&frame.device()),
      tiles_(frame.device()),
      depth_(frame, "gbuffer_depth"),
      id_(frame, "gbuffer_id"),
      resolve_(frame, "gbuffer_resolve"),
      abuffer_(frame, width, height) {
    requireUsage(width > 0 && height > 0 && width <= RASTER_MAX_SIZE && height <= RASTER_MAX_SIZE,
                 "--size {}x{} is outside of 1x1 to {}x{} pixels", width, height, RASTER_MAX_SIZE,
                 RASTER_MAX_SIZE);
    auto& device = *device_;
    if (allowAtomics64 && device.info().atomics64) makeWide();
    const auto pixels = static_cast<std::uint64_t>(paddedPixels(width, height));
    depthBits_ = Buffer<std::uint32_t>(device, "depth bits", wide_ ? 1 : pixels);
    visibility_ = Buffer<std::uint32_t>(device, "visibility buffer", wide_ ? 2 * pixels : pixels);
    gbuffer_.width = width;
    gbuffer_.height = height;
    fitRows();
    gbuffer_.planes = Buffer<float>(device, "G-buffer", runtime::Shape{1, GB_PLANES, pixels});
}

/// Leaves wide_ null where the driver lists 64-bit atomics and does not build them.
void GBufferPass::makeWide() try {
    const runtime::Program atomic64(*device_, "atomic64");
    wide_ = std::make_unique<Kernels<Buffer<std::uint32_t>>>(atomic64, "gbuffer_raster64");
} catch (const Error& error) {
    if (error.code() != ExitCode::noDevice) throw;
    const std::string text = error.what();
    device_->warn(fmt::format("what the camera sees is rasterised in two passes: {}",
                              text.substr(0, text.find('\n'))));
}

/// Leaves the planes unallocated where the number of rows has changed.
void GBufferPass::fitRows() {
    if (gbuffer_.planeStride > 0 && gbuffer_.fragmentRows == abuffer_.rows()) return;
    gbuffer_.fragmentRows = abuffer_.rows();
    gbuffer_.planeStride = paddedPixels(gbuffer_.width, gbuffer_.rows());
    gbuffer_.planes = Buffer<float>();
}

bool GBufferPass::grew() {
    const bool opaque = tiles_.grew(), blended = abuffer_.grew();
    fitRows();
    return opaque || blended;
}

std::uint64_t GBufferPass::plannedBytes(int width, int height) {
    return static_cast<std::uint64_t>(paddedPixels(width, height)) * (GB_PLANES + 2) *
           sizeof(float);
}

void GBufferPass::rasterise(const shared::RasterView& view, const Mesh& mesh) {
    tiles_.clear();
    visibility_.fill(0);
    if (wide_) {
        wide_->launch(view, mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours, mesh.texels,
                      visibility_);
        return;
    }
    depthBits_.fill(0);
    depth_.launch(view, mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours, mesh.texels,
                  depthBits_);
    tiles_.clear();
    id_.launch(view, mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours, mesh.texels, depthBits_,
               visibility_);
}

const GBuffer& GBufferPass::run(const Mesh& mesh, const scene::CameraFrame& camera,
                                const glm::dvec3& centre) {
    device_->profiler().beginStage("raster");
    auto view = scene::rasterView(camera, centre, gbuffer_.width, gbuffer_.height);
    view.requireFlags = DRAW_ANY;
    view.cullBack = DRAW_SINGLE_SIDED;
    view.triangleCount = static_cast<int>(mesh.triangleCount);
    rasterise(view, mesh);
    const FragmentLists& lists = abuffer_.lists();
    gbuffer_.blended = mesh.hasBlend ? &lists : nullptr;
    if (mesh.hasBlend) abuffer_.run(view, mesh, wide_ ? visibility_ : depthBits_, wide_ ? 2 : 1);
    fitRows();
    if (!gbuffer_.planes.allocated())
        gbuffer_.planes = Buffer<float>(
            *device_, "G-buffer",
            runtime::Shape{1, GB_PLANES, static_cast<std::uint64_t>(gbuffer_.planeStride)});
    device_->profiler().beginStage("resolve");
    auto params = paramsFor(camera, centre);
    params.width = gbuffer_.width;
    params.height = gbuffer_.height;
    params.planeStride = gbuffer_.planeStride;
    params.idStride = wide_ ? 2 : 1;
    params.hasPrevious = mesh.moved ? 1 : 0;
    params.fragmentCapacity = lists.capacity;
    resolve_.launch({static_cast<std::uint64_t>(gbuffer_.planeStride)}, {64}, params, view,
                    mesh.positions, mesh.normals, mesh.tangents, mesh.previousPositions,
                    mesh.indices, mesh.triangleDraw, mesh.draws, mesh.materials, mesh.uvs,
                    mesh.colours, mesh.texels, visibility_, lists.ends, lists.fragments,
                    lists.owners, lists.coverage, gbuffer_.planes);
    return gbuffer_;
}

}  // namespace penumbra::gbuffer
