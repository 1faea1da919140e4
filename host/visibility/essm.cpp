// SPDX-License-Identifier: MIT
#include "host/visibility/essm.h"

#include <algorithm>
#include <cmath>

#include "host/visibility/single_view.h"
#include "runtime/profiler.h"

namespace penumbra::visibility {
namespace {

MapRasterSettings mapSettings(const EssmSettings& settings, bool castersOnly) {
    MapRasterSettings maps;
    maps.form = MapForm::textbook;  // one map: all work-items share it
    maps.cull = castersOnly ? settings.cull : Cull::none;
    maps.castersOnly = castersOnly;
    return maps;
}

}  // namespace

EssmSource::EssmSource(const runtime::Program& mvr, const runtime::Program& essm,
                       const EssmSettings& settings)
    : device_(&mvr.device()),
      settings_(settings),
      casters_(mvr, mapSettings(settings, true)),
      receivers_(mvr, mapSettings(settings, false)),
      base_(essm, "essm_base"),
      reduce_(essm, "essm_reduce") {}

void EssmSource::begin(const Inputs& inputs, LightView& view, Buffer<float>& samples,
                       Buffer<shared::MultiViewCounters>& counters) {
    view_ = &view;
    casters_.begin(inputs, view, samples, counters);
    receivers_.begin(inputs, view, samples, counters);
    auto& p = params_;
    p = {};
    p.exponent = settings_.exponent;
    p.leak = settings_.leak;
    p.leastRadius = settings_.leastRadius;
    // Depths are spread over the casters and half their radius behind them; receivers farther away
    // share the last one
    const double nearZ = view.params.near;
    const double behind = 0.5 * inputs.casters.radius();
    const double range = std::max(view.farthestCaster + behind - nearZ, 1e-6 * nearZ);
    p.nearZ = static_cast<float>(nearZ);
    p.inverseRange = static_cast<float>(1 / range);
    // A disk becomes the square of its area
    const float rim = view.disk ? static_cast<float>(std::sqrt(3.14159265358979323846) / 2) : 1.0F;
    p.reachX = rim * view.params.halfWidth * view.params.focal / view.params.near;
    p.reachY = rim * view.params.halfHeight * view.params.focal / view.params.near;
    for (int size = view.params.resolution; p.levels < ESSM_MAX_LEVELS; size = (size + 1) / 2) {
        p.firstTexel[p.levels] = p.texels;
        p.size[p.levels++] = size;
        p.texels += size * size;
        if (size == 1) break;
    }
    pyramid_.grow(*device_, "pyramid of exponentials", 2 * static_cast<std::uint64_t>(p.texels));
    receiverMap_.grow(*device_, "receivers' depth map",
                      static_cast<std::uint64_t>(view.params.mapStride));
}

void EssmSource::fill(const MapBatch& batch) {
    casters_.fill(batch);
    receivers_.fill({batch.firstView, batch.viewCount, &receiverMap_, nullptr});
    const auto texels = [&](int level) {
        const auto size = static_cast<std::uint64_t>(params_.size[level]);
        return runtime::Range{size * size};
    };
    base_.launch(texels(0), {64}, view_->params, params_, *batch.maps32, receiverMap_, pyramid_);
    for (int level = 1; level < params_.levels; ++level)
        reduce_.launch(texels(level), {64}, params_, level, pyramid_);
}

std::uint64_t EssmSource::frameBytes(const Mesh& mesh) const {
    const auto size = static_cast<std::uint64_t>(settings_.resolution);
    // Two planes of 4/3 maps, a little more where sizes are odd
    return casters_.frameBytes(mesh) + receivers_.frameBytes(mesh) + size * size * 4 +
           size * size * 11 + 4096;
}

bool EssmSource::grew() {
    const bool receivers = receivers_.grew();
    return casters_.grew() || receivers;
}

std::uint64_t EssmSource::takeTriangles() {
    receivers_.takeTriangles();
    return casters_.takeTriangles();
}

EssmReader::EssmReader(const runtime::Program& essm, const EssmSettings& settings,
                       const EssmSource& source)
    : device_(&essm.device()), settings_(settings), source_(&source), essm_(essm, "essm") {}

void EssmReader::read(const LightView& view, const MapBatch&, ReceiverImage& receivers) {
    shared::LookupParams bias{};
    applyBias({settings_.bias, settings_.constantBias, 0}, bias);
    const runtime::Range items{
        static_cast<std::uint64_t>(receivers.stride / device_->info().lanes)};
    essm_.launch(items, {64}, view.params, bias, source_->params(), receivers.stride,
                 receivers.planes, source_->pyramid(), receivers.hidden);
}

Essm::Essm(const TechniqueContext& context)
    : settings_(parseSettings<EssmSettings>("essm", context.values)),
      shared_(context.device, "multi_view"),
      maps_(context.device, "mvr"),
      program_(context.device, "essm"),
      multiView_(shared_, settings_, context.width, context.height, context.fragmentRows),
      source_(maps_, program_, settings_),
      reader_(program_, settings_, source_) {}

std::uint64_t Essm::plannedBytes(const TechniqueContext& context) {
    const auto settings = parseSettings<EssmSettings>("essm", context.values);
    const auto size = static_cast<std::uint64_t>(settings.resolution);
    // A second map and two planes of 4/3 maps
    return MultiView::plannedBytes(settings, context.width, context.height) + size * size * 15;
}

void Essm::run(const Inputs& inputs, Visibility& visibility) {
    multiView_.run(inputs, centralView(inputs.light), source_, reader_, visibility);
}

Counts Essm::takeCounts() {
    Counts counts = multiView_.takeCounts();
    counts.mapTriangles = source_.takeTriangles();
    return counts;
}

}  // namespace penumbra::visibility
