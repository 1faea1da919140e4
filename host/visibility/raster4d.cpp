// SPDX-License-Identifier: MIT
#include "host/visibility/raster4d.h"

#include <algorithm>

#include "host/visibility/light_view.h"
#include "host/visibility/raster4d_grid.h"
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
           casters * ((R4_CORNERS + R4_WORLD) * sizeof(float) + sizeof(U32)) +
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
    world_.grow(*device_, "sorted triangles of the world", slots * R4_WORLD);
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
    trianglesKernel_.launch(slots(0), {64}, p, mesh.positions, grid_, mesh.indices,
                            mesh.triangleDraw, mesh.draws, keyBuffer_, sorted_, bounds_[0],
                            corners_, world_, order_);
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
      masks_(context.device, "occlusion masks", 1) {
    if (settings_.method == PairMethod::grid)
        grid_ = std::make_unique<Raster4dGrid>(frame_, program_, settings_);
}

Raster4d::~Raster4d() = default;

bool Raster4d::grew() {
    return grid_ && grid_->grew();
}

std::uint64_t Raster4d::plannedBytes(const TechniqueContext& context) {
    return LightReceivers::bytesFor(context.width, context.height);
}

std::uint64_t Raster4d::maskBytes(const scene::AreaLight& light) const {
    const LightGrid grid = fitLightGrid(light);
    return static_cast<std::uint64_t>(grid.rows * grid.words()) *
           static_cast<std::uint64_t>(receivers_.image().planeStride) * sizeof(U32);
}

void Raster4d::keepMasks(OcclusionMasks& masks) const {
    masks.columns = cells_.grid.columns;
    masks.rows = cells_.grid.rows;
    masks.samples = cells_.grid.sample;
    masks.stride = static_cast<std::size_t>(receivers_.image().planeStride);
    masks.bits =
        masks_.download(0, static_cast<std::uint64_t>(masks.rows * masks.words()) * masks.stride);
}

void LightCells::place(runtime::Device& device, const scene::AreaLight& newLight) {
    if (x.allocated() && light.samples == newLight.samples && light.width == newLight.width &&
        light.height == newLight.height)
        return;
    light = newLight;
    grid = fitLightGrid(light);
    std::vector<float> columns, rows;
    for (const auto& p : grid.position) {
        columns.push_back(p.x);
        rows.push_back(p.y);
    }
    std::vector<std::uint32_t> without(static_cast<std::size_t>(grid.words() * grid.rows), ~0U);
    for (int row = 0; row < grid.rows; ++row)
        for (int column = 0; column < grid.columns; ++column)
            if (grid.sample[grid.cellAt(row, column)] >= 0) {
                const int word = column / 32 * grid.rows + row;
                without[static_cast<std::size_t>(word)] &= ~(1U << (column % 32));
            }
    const auto cells = grid.sample.size();
    x.grow(device, "columns of samples", cells);
    y.grow(device, "rows of samples", cells);
    sample.grow(device, "cells' samples", cells);
    empty.grow(device, "cells without a sample", without.size());
    x.uploadLater(columns);
    y.uploadLater(rows);
    sample.uploadLater(grid.sample);
    empty.uploadLater(without);
}

void Raster4d::run(const Inputs& inputs, Visibility& visibility) {
    visibility.channels = 1;
    auto& device = program_.device();
    cells_.place(device, inputs.light);
    auto params = gridParams(cells_.grid, inputs.light, inputs.casters, inputs.centre);
    params.sampleStride = shuffleStride(params.samples);
    params.tileGroups = device.info().isCpu ? 16 : 1;
    params.rowAtOnce = settings_.rowAtOnce ? 1 : 0;
    if (inputs.masks) {
        params.keepMasks = 1;
        masks_.grow(device, "occlusion masks", maskBytes(inputs.light) / sizeof(U32));
        masks_.fill(0);
    }
    receivers_.run(inputs, params, visibility);
    triangles_.run(inputs.mesh, params);
    device.profiler().beginStage("masks");
    if (grid_)
        grid_->run(inputs, params, receivers_, triangles_, cells_, visibility, masks_);
    else
        runBins(inputs, params, visibility);
    if (inputs.masks) keepMasks(*inputs.masks);
}

void Raster4d::runBins(const Inputs& inputs, const shared::Raster4dParams& params,
                       Visibility& visibility) {
    const auto& mesh = inputs.mesh;
    const auto tile = static_cast<std::uint64_t>(params.tileGroups) * kWidth;
    const auto pixels = static_cast<std::uint64_t>(params.planeStride);
    bins_.launch({(pixels + tile - 1) / tile}, {1}, params, receivers_.image(),
                 inputs.gbuffer.planes, receivers_.planes(), receivers_.count(),
                 triangles_.bounds(0), triangles_.bounds(1), triangles_.bounds(2),
                 triangles_.corners(), triangles_.world(), triangles_.order(), cells_.x, cells_.y,
                 cells_.sample, cells_.empty, mesh.indices, mesh.triangleDraw, mesh.draws,
                 mesh.materials, mesh.uvs, mesh.colours, mesh.texels, visibility.planes, masks_);
}

}  // namespace penumbra::visibility
