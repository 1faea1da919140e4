// SPDX-License-Identifier: MIT
#include "host/visibility/raster4d.h"

#include <algorithm>

#include "host/visibility/light_view.h"
#include "kernels/shared/gbuffer.h"
#include "kernels/shared/multi_view.h"
#include "runtime/profiler.h"

namespace penumbra::visibility {
namespace {

constexpr std::uint64_t kWidth = R4_WIDTH;

std::uint64_t nodesOver(std::uint64_t below) {
    return (below + kWidth - 1) / kWidth;
}

}  // namespace

LightTriangles::LightTriangles(const runtime::Program& frame, const runtime::Program& raster4d)
    : device_(&frame.device()),
      sort_(frame),
      vertices_(raster4d, "raster4d_vertices"),
      keys_(raster4d, "raster4d_keys"),
      trianglesKernel_(raster4d, "raster4d_triangles"),
      nodes_(raster4d, "raster4d_nodes") {}

std::uint64_t LightTriangles::bytesFor(const Mesh& mesh) {
    const std::uint64_t casters = nodesOver(mesh.casterTriangleCount) * kWidth;
    return mesh.vertexCount * sizeof(shared::float4) +
           4 * std::uint64_t{mesh.triangleCount} * sizeof(U32) +  // keys, sorted twice
           casters * (R4_CORNERS * sizeof(float) + sizeof(U32)) +
           casters * R4_BOUNDS * sizeof(float) * 17 / 16;
}

void LightTriangles::plan(const Mesh& mesh, shared::Raster4dParams& p) {
    p.triangleCount = static_cast<int>(mesh.triangleCount);
    p.casterCount = static_cast<int>(mesh.casterTriangleCount);
    const auto triangles = std::max<std::uint64_t>(mesh.triangleCount, 1);
    grid_.grow(*device_, "vertices in the light's grid",
               std::max<std::uint64_t>(mesh.vertexCount, 1));
    keyBuffer_.grow(*device_, "triangle keys", triangles);
    sorted_.grow(*device_, "sorted triangles", triangles);
    std::uint64_t nodes = mesh.casterTriangleCount;
    for (int level = 0; level < R4_LEVELS; ++level) {
        nodes = nodesOver(nodes);
        p.nodeCount[level] = static_cast<int>(nodes);
        bounds_[level].grow(*device_, "triangles' bounds",
                            std::max<std::uint64_t>(nodes, 1) * R4_BOUNDS * kWidth);
    }
    const auto slots =
        std::max<std::uint64_t>(static_cast<std::uint64_t>(p.nodeCount[0]), 1) * kWidth;
    corners_.grow(*device_, "corners in the light's grid", slots * R4_CORNERS);
    order_.grow(*device_, "order of triangles", slots);
}

void LightTriangles::run(const Mesh& mesh, shared::Raster4dParams& p) {
    device_->profiler().beginStage("triangles");
    plan(mesh, p);
    vertices_.launch({mesh.vertexCount}, {64}, p, mesh.vertexCount, mesh.positions, grid_);
    keys_.launch({mesh.triangleCount}, {64}, p, grid_, mesh.indices, mesh.triangleDraw, mesh.draws,
                 keyBuffer_, sorted_);
    sort_.run(keyBuffer_, sorted_, mesh.triangleCount);
    const auto slots = [&](int level) {
        return runtime::Range{static_cast<std::uint64_t>(p.nodeCount[level]) * kWidth};
    };
    trianglesKernel_.launch(slots(0), {64}, p, grid_, mesh.indices, mesh.triangleDraw, mesh.draws,
                            keyBuffer_, sorted_, bounds_[0], corners_, order_);
    for (int level = 1; level < R4_LEVELS; ++level)
        nodes_.launch(slots(level), {64}, p, level, bounds_[level - 1], bounds_[level]);
}

LightReceivers::LightReceivers(const runtime::Program& frame, const runtime::Program& raster4d,
                               int width, int height)
    : device_(&frame.device()),
      sort_(frame),
      receivers_(raster4d, "raster4d_receivers"),
      gather_(raster4d, "raster4d_gather"),
      count_(*device_, "count of receivers", 1) {
    image_.width = width;
    image_.height = height;
    image_.planeStride = shared::gbufferStride(width * height);
    image_.pixelStep = 1;
    image_.originOffset = SHADOW_ORIGIN_OFFSET;
    const auto stride = static_cast<std::uint64_t>(image_.planeStride);
    keys_ = Buffer<U32>(*device_, "receiver keys", stride);
    pixels_ = Buffer<U32>(*device_, "sorted receivers", stride);
    planes_ = Buffer<float>(*device_, "receivers in the light's grid", stride * R4_RECEIVER_PLANES);
}

std::uint64_t LightReceivers::bytesFor(int width, int height) {
    const auto stride = static_cast<std::uint64_t>(shared::gbufferStride(width * height));
    return stride * (4 * sizeof(U32) + R4_RECEIVER_PLANES * sizeof(float));  // keys, sorted twice
}

void LightReceivers::run(const Inputs& inputs, shared::Raster4dParams& p, Visibility& visibility) {
    device_->profiler().beginStage("receivers");
    image_.worldMagnitude = static_cast<float>(inputs.casters.empty ? 0 : inputs.casters.radius());
    p.planeStride = p.receiverStride = image_.planeStride;
    const runtime::Range pixels{static_cast<std::uint64_t>(image_.planeStride)};
    receivers_.launch(pixels, {64}, p, image_, inputs.gbuffer.planes, visibility.state,
                      visibility.planes, keys_, pixels_);
    sort_.run(keys_, pixels_, static_cast<U32>(image_.planeStride));
    gather_.launch(pixels, {64}, p, image_, inputs.gbuffer.planes, keys_, pixels_, planes_, count_);
}

Raster4d::Raster4d(const TechniqueContext& context)
    : settings_(parseSettings<Raster4dSettings>("raster4d", context.values)),
      frame_(context.device, "frame"),
      program_(context.device, "raster4d"),
      receivers_(frame_, program_, context.width, context.height),
      triangles_(frame_, program_),
      bins_(program_, "raster4d_bins"),
      masks_(context.device, "occlusion masks", 1) {}

std::uint64_t Raster4d::plannedBytes(const TechniqueContext& context) {
    return LightReceivers::bytesFor(context.width, context.height);
}

void Raster4d::placeCells(const scene::AreaLight& light) {
    auto& device = program_.device();
    const bool same = cells_.light.samples == light.samples && cells_.light.width == light.width &&
                      cells_.light.height == light.height && cells_.x.allocated();
    if (same) return;
    cells_.light = light;
    cells_.grid = fitLightGrid(light);
    const auto& grid = cells_.grid;
    std::vector<float> x, y;
    for (const auto& p : grid.position) {
        x.push_back(p.x);
        y.push_back(p.y);
    }
    std::vector<U32> empty(static_cast<std::size_t>(grid.words() * grid.rows), ~0U);
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            if (grid.sample[static_cast<std::size_t>(row * grid.columns + column)] >= 0)
                empty[static_cast<std::size_t>(column / 32 * grid.rows + row)] &=
                    ~(1U << (column % 32));
    const auto cells = grid.sample.size();
    cells_.x.grow(device, "columns of samples", cells);
    cells_.y.grow(device, "rows of samples", cells);
    cells_.sample.grow(device, "cells' samples", cells);
    cells_.empty.grow(device, "cells without a sample", empty.size());
    cells_.x.uploadLater(x);
    cells_.y.uploadLater(y);
    cells_.sample.uploadLater(grid.sample);
    cells_.empty.uploadLater(empty);
}

void Raster4d::run(const Inputs& inputs, Visibility& visibility) {
    visibility.channels = 1;
    placeCells(inputs.light);
    auto params = gridParams(cells_.grid, inputs.light, inputs.casters, inputs.centre);
    params.sampleStride = shuffleStride(params.samples);
    params.tileGroups = program_.device().info().isCpu ? 16 : 1;
    receivers_.run(inputs, params, visibility);
    triangles_.run(inputs.mesh, params);
    program_.device().profiler().beginStage("masks");
    const auto& mesh = inputs.mesh;
    const auto tile = static_cast<std::uint64_t>(params.tileGroups * R4_WIDTH);
    const auto pixels = static_cast<std::uint64_t>(params.planeStride);
    bins_.launch({(pixels + tile - 1) / tile}, {1}, params, receivers_.image(),
                 inputs.gbuffer.planes, receivers_.planes(), receivers_.count(),
                 triangles_.bounds(0), triangles_.bounds(1), triangles_.bounds(2),
                 triangles_.corners(), triangles_.order(), cells_.x, cells_.y, cells_.sample,
                 cells_.empty, mesh.indices, mesh.triangleDraw, mesh.draws, mesh.materials,
                 mesh.uvs, mesh.colours, mesh.texels, visibility.planes, masks_);
}

}  // namespace penumbra::visibility
