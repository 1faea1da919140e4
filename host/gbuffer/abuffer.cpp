// SPDX-License-Identifier: MIT
#include "host/gbuffer/abuffer.h"

#include <algorithm>
#include <limits>

#include "kernels/shared/gbuffer.h"
#include "runtime/error.h"
#include "runtime/profiler.h"

namespace penumbra::gbuffer {
namespace {

/// Kernels index all planes of the G-buffer with 32 bits.
constexpr std::uint64_t kMaxEntries = std::numeric_limits<int>::max() / GB_PLANES - 2048;

}  // namespace

ABuffer::ABuffer(const runtime::Program& frame, int width, int height)
    : device_(&frame.device()),
      width_(width),
      tiles_(frame.device()),
      scan_(frame),
      count_(frame, "abuffer_count"),
      fill_(frame, "abuffer_fill"),
      sort_(frame, "abuffer_sort"),
      total_(frame.device(), "fragment count", 1),
      layers_(frame.device(), "fragment layers", 1) {
    lists_.pixels = width * height;
    for (auto* list : {&lists_.ends, &lists_.fragments, &lists_.owners})
        *list = Buffer<U32>(*device_, "no fragments", 1);
    lists_.coverage = Buffer<float>(*device_, "no fragments", 1);
}

void ABuffer::allocate(int rows) {
    rows_ = rows;
    lists_.capacity = static_cast<U32>(rows) * static_cast<U32>(width_);
    const std::uint64_t n = lists_.capacity;
    lists_.ends.grow(*device_, "ends of fragment lists", static_cast<U32>(lists_.pixels));
    lists_.fragments.grow(*device_, "blended fragments", 2 * n);
    lists_.owners.grow(*device_, "pixels of blended fragments", n);
    lists_.coverage.grow(*device_, "coverage of blended fragments", COVERAGE_PLANES * n);
}

void ABuffer::run(shared::RasterView view, const Mesh& mesh, const Buffer<U32>& opaque,
                  int depthStride) {
    if (rows_ == 0) allocate(1);
    device_->profiler().beginStage("fragments");
    view.requireFlags = DRAW_ANY | DRAW_BLEND;
    shared::ABufferParams params{};
    params.pixels = lists_.pixels;
    params.depthStride = depthStride;
    params.capacity = lists_.capacity;
    tiles_.clear();
    lists_.ends.fill(0);
    count_.launch(view, mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours, mesh.texels, params,
                  opaque, lists_.ends);
    scan_.run(lists_.ends, static_cast<U32>(lists_.pixels), total_);
    tiles_.clear();
    fill_.launch(view, mesh, tiles_, mesh.materials, mesh.uvs, mesh.colours, mesh.texels, params,
                 opaque, lists_.ends, lists_.fragments, lists_.owners);
    layers_.fill(0);
    sort_.launch({static_cast<std::uint64_t>(lists_.pixels)}, {64}, params, mesh.positions,
                 mesh.indices, mesh.triangleDraw, mesh.draws, lists_.ends, lists_.fragments,
                 layers_);
}

bool ABuffer::grew() {
    if (rows_ == 0) return false;
    const bool tiles = tiles_.grew();
    counts_ = {total_.download()[0], layers_.download()[0]};
    const std::uint64_t wanted = counts_.fragments;
    if (wanted <= lists_.capacity) return tiles;
    const auto pixels = static_cast<std::uint64_t>(lists_.pixels);
    if (pixels + wanted > kMaxEntries)
        throw Error(
            fmt::format("out of memory: {:.1f} million blended fragments before {:.1f} million "
                        "pixels, supersampling included; at most {:.1f} million fit in all: use a "
                        "smaller --size or --supersample",
                        static_cast<double>(wanted) / 1e6, static_cast<double>(pixels) / 1e6,
                        static_cast<double>(kMaxEntries) / 1e6),
            ExitCode::outOfMemory);
    // An eighth more, so that a sequence grows its lists a few times and not in each frame
    const auto width = static_cast<std::uint64_t>(width_);
    const auto room = std::min(wanted + wanted / 8, kMaxEntries - pixels);
    allocate(static_cast<int>((room + width - 1) / width));
    return true;
}

}  // namespace penumbra::gbuffer
