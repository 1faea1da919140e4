// SPDX-License-Identifier: MIT
#include "host/visibility/multi_view.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "kernels/shared/gbuffer.h"
#include "runtime/error.h"
#include "runtime/profiler.h"

namespace penumbra::visibility {
namespace {

constexpr std::uint64_t kSampleBytes = 4096 * 2 * sizeof(float);
constexpr int kStreamedViews = 4;  // maps that a CPU holds at a time: more fall out of its caches

}  // namespace

MultiView::MultiView(const runtime::Program& multiView, const MapSettings& settings, int width,
                     int height, int fragmentRows)
    : device_(&multiView.device()),
      settings_(settings),
      stride_(shared::gbufferStride(width * height)),
      receivers_(multiView, "receivers"),
      occupancy_(multiView),
      pack_(multiView, "map_pack"),
      average_(multiView, "map_average"),
      upsample_(multiView, "map_upsample") {
    const int step = settings.halfResolution ? 2 : 1;
    image_.width = width;
    image_.height = height;
    image_.fragmentRows = fragmentRows;
    image_.planeStride = stride_;
    image_.pixelStep = step;
    image_.receiverWidth = (width + step - 1) / step;
    const int rows = height - fragmentRows;
    const int receivers = image_.receiverWidth * ((rows + step - 1) / step);
    image_.receiverStride = shared::gbufferStride(receivers + width * fragmentRows);
    image_.originOffset = SHADOW_ORIGIN_OFFSET;
    const auto slots = static_cast<std::uint64_t>(image_.receiverStride);
    auto& r = receiverImage_;
    r.width = image_.receiverWidth;
    r.stride = image_.receiverStride;
    r.onScreen = receivers;
    r.planes = Buffer<float>(*device_, "receivers", runtime::Shape{1, RECEIVER_PLANES, slots});
    r.hidden = Buffer<std::uint32_t>(*device_, "hidden tests", slots);
    maps32_ = Buffer<std::uint32_t>(*device_, "depth maps", 1);
    maps16_ = Buffer<std::uint16_t>(*device_, "depth maps", 1);
}

std::uint64_t MultiView::plannedBytes(const MapSettings& settings, int width, int height) {
    const auto size = static_cast<std::uint64_t>(settings.resolution);
    const std::uint64_t shrink = settings.halfResolution ? 4 : 1;
    const auto pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    return size * size * static_cast<std::uint64_t>(settings.depthBits / 8) +
           pixels / shrink * (RECEIVER_PLANES + 1) * sizeof(float);
}

std::uint64_t MultiView::frameBytes(bool wideMaps) const {
    const auto size = static_cast<std::uint64_t>(settings_.resolution);
    const std::uint64_t texel = settings_.depthBits == 32 ? 4U
                                : wideMaps                ? 6U
                                                          : 2U;  // 16 bits are packed from 32
    return (size * size + 16) * texel + kSampleBytes;
}

int MultiView::batchSize(const LightView& view, bool wide) const {
    const auto texels = static_cast<std::uint64_t>(view.params.mapStride);
    const std::uint64_t perView = texels * ((settings_.depthBits == 16 ? 2U : 0U) +
                                            (settings_.depthBits == 32 || wide ? 4U : 0U));
    const auto& info = device_->info();
    const auto used = device_->memory().current;
    const auto limit = device_->memoryLimitBytes();
    const std::uint64_t held = maps32_.bytes() + maps16_.bytes();
    const std::uint64_t usable = (limit > used ? limit - used : 0) + held;
    // Launches over all texels of a batch count them with 32 bits
    const std::uint64_t most = std::min(std::min(usable / 10 * 8, info.maxAllocBytes) / perView,
                                        std::uint64_t{0x7fffffff} / texels);
    int batch = view.params.views;
    if (settings_.viewsPerBatch > 0)
        batch = settings_.viewsPerBatch;
    else if (info.isCpu)
        batch = std::max(kStreamedViews, info.computeUnits);
    batch = static_cast<int>(std::min<std::uint64_t>(static_cast<std::uint64_t>(batch), most));
    // A tenth or two are left free for lists that grow, but not at the price of the only map
    if (batch < 1 && perView <= usable && perView <= info.maxAllocBytes) batch = 1;
    if (batch < 1)
        throw Error(
            fmt::format(
                "out of memory: one depth map of {}x{} needs {:.1f} MB, {:.1f} MB are left on "
                "{}; use a smaller resolution",
                view.params.resolution, view.params.resolution,
                static_cast<double>(perView) / 1048576.0, static_cast<double>(usable) / 1048576.0,
                info.name),
            ExitCode::outOfMemory);
    return std::min(batch, view.params.views);
}

void MultiView::allocateMaps(const LightView& view, int batch, bool wide) {
    const auto texels =
        static_cast<std::uint64_t>(view.params.mapStride) * static_cast<std::uint64_t>(batch);
    if (settings_.depthBits == 16) maps16_.grow(*device_, "depth maps", texels);
    if (settings_.depthBits == 32 || wide) maps32_.grow(*device_, "depth maps", texels);
}

void MultiView::pack(const LightView& view, const MapBatch& batch) {
    const auto texels = static_cast<std::uint32_t>(view.params.mapStride) *
                        static_cast<std::uint32_t>(batch.viewCount);
    pack_.launch({texels}, {64}, texels, *batch.maps32, *batch.maps16);
}

void MultiView::run(const Inputs& inputs, const scene::AreaLight& views, MapSource& source,
                    MapReader& reader, Visibility& visibility) {
    require(inputs.gbuffer.planeStride == stride_,
            "the technique was made for G-buffer planes of {} floats, they have {}", stride_,
            inputs.gbuffer.planeStride);
    LightView view =
        fitLightView(views, inputs.casters, inputs.centre, settings_.resolution, source.density());
    view.params.depthBits = settings_.depthBits;
    if (!view.complete && settings_.outside == Outside::lit)
        warnings_.push_back(
            fmt::format("light '{}': its views cannot hold all casters, and receivers outside of "
                        "them are lit; outside=raytrace traces them",
                        inputs.light.name));
    if (nextLight_ == lights_.size()) lights_.push_back(std::make_unique<PerLight>());
    PerLight& light = *lights_[nextLight_++];
    light.samples.grow(*device_, "light samples", view.samples.size());
    light.samples.uploadLater(view.samples);
    light.counters.grow(*device_, "counters", 1);
    light.counters.fill({});

    auto& profiler = device_->profiler();
    source.begin(inputs, view, light.samples, light.counters);
    profiler.beginStage("lighting");
    image_.worldMagnitude = static_cast<float>(inputs.casters.empty ? 0 : inputs.casters.radius());
    const bool trace = !view.complete && settings_.outside == Outside::raytrace;
    image_.outsideState = trace ? STATE_OUTSIDE : STATE_TESTED;
    image_.countOutside = view.complete ? 0 : 1;
    if (image_.pixelStep > 1) receiverImage_.planes.fill(0);
    if (reader.channels() > 1) {
        const auto channels = static_cast<std::uint64_t>(reader.channels());
        receiverImage_.hidden.grow(*device_, "hidden tests",
                                   channels * static_cast<std::uint64_t>(image_.receiverStride));
        receiverImage_.hidden.fill(0);
    }
    receiverImage_.samples = &light.samples;
    const auto pixels = static_cast<std::uint64_t>(stride_);
    receivers_.launch({pixels}, {64}, image_, view.params, inputs.gbuffer.planes,
                      receiverImage_.planes, visibility.state, receiverImage_.hidden,
                      light.counters);
    if (settings_.skipLit && reader.testsSamples())
        occupancy_.skip(inputs.mesh, view, image_.receiverStride, receiverImage_.planes);

    if (source.makesMaps()) {
        readMaps(inputs, view, source, reader);
    } else {
        source.fill({0, view.params.views, nullptr, nullptr});
        profiler.beginStage("lighting");
        reader.read(view, {0, view.params.views, nullptr, nullptr}, receiverImage_);
    }
    average(view.params.views * reader.weight(), reader.channels(), inputs.gbuffer, visibility);
    if (trace) traceOutside(inputs, visibility);
}

void MultiView::readMaps(const Inputs& inputs, const LightView& view, MapSource& source,
                         MapReader& reader) {
    auto& profiler = device_->profiler();
    mapBytes_ += static_cast<std::uint64_t>(view.params.views) *
                 static_cast<std::uint64_t>(settings_.resolution) *
                 static_cast<std::uint64_t>(settings_.resolution) *
                 static_cast<std::uint64_t>(settings_.depthBits / 8);
    const bool wide = source.needsWideMaps();
    const int batch = batchSize(view, wide);
    allocateMaps(view, batch, wide);
    for (int first = 0; first < view.params.views; first += batch) {
        MapBatch maps{first, std::min(batch, view.params.views - first), &maps32_,
                      settings_.depthBits == 16 ? &maps16_ : nullptr};
        profiler.beginStage("depth maps");
        source.fill(maps);
        if (wide && maps.maps16) pack(view, maps);
        profiler.beginStage("lighting");
        reader.read(view, maps, receiverImage_);
        if (inputs.depthMaps) keepMaps(view, maps, *inputs.depthMaps);
    }
}

void MultiView::traceOutside(const Inputs& inputs, Visibility& visibility) {
    if (!tracer_) tracer_ = std::make_unique<Tracer>(*device_, image_.width, image_.height);
    tracer_->bvh.build(inputs.mesh, inputs.casters, inputs.centre);
    tracer_->pass.run(inputs, tracer_->bvh, STATE_OUTSIDE, false, visibility);
}

void MultiView::average(int tests, int channels, const GBuffer& gbuffer, Visibility& visibility) {
    const runtime::Range items{static_cast<std::uint64_t>(stride_),
                               static_cast<std::uint64_t>(channels)};
    if (image_.pixelStep > 1)
        upsample_.launch(items, {64}, image_, 1, tests, gbuffer.planes, visibility.state,
                         receiverImage_.hidden, visibility.planes);
    else
        average_.launch(items, {64}, stride_, 1, tests, visibility.state, receiverImage_.hidden,
                        visibility.planes);
    visibility.channels = channels;
}

void MultiView::keepMaps(const LightView& view, const MapBatch& batch, DepthMaps& out) {
    const auto size = static_cast<std::size_t>(view.params.resolution);
    const auto stride = static_cast<std::size_t>(view.params.mapStride);
    out.views = view.params.views;
    out.size = view.params.resolution;
    out.depths.resize(static_cast<std::size_t>(out.views) * size * size);
    const auto total = static_cast<std::uint64_t>(batch.viewCount) * stride;
    std::vector<float> depths;
    if (batch.maps16) {
        for (const auto value : batch.maps16->download(0, total))
            depths.push_back(static_cast<float>(value) / 65535.0F);
    } else {
        for (const auto bits : batch.maps32->download(0, total))
            depths.push_back(std::bit_cast<float>(bits));
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(batch.viewCount); ++i)
        std::copy_n(depths.begin() + static_cast<std::ptrdiff_t>(i * stride), size * size,
                    out.depths.begin() +
                        static_cast<std::ptrdiff_t>(
                            (static_cast<std::size_t>(batch.firstView) + i) * size * size));
}

Counts MultiView::takeCounts() {
    Counts counts;
    for (std::size_t i = 0; i < nextLight_; ++i) {
        const auto c = lights_[i]->counters.download()[0];
        counts.points += c.points;
        counts.outsideFov += c.outsideFov;
        counts.nearPoints += c.nearPoints;
    }
    counts.mapBytes = std::exchange(mapBytes_, 0);
    nextLight_ = 0;
    warnings_.clear();
    return counts;
}

}  // namespace penumbra::visibility
