// SPDX-License-Identifier: MIT
#include "host/visibility/vwss.h"

#include <algorithm>

#include "runtime/profiler.h"

namespace penumbra::visibility {

/// Fills maps from points: generated once a light when buffered, once a traversal otherwise.
class Vwss::Source : public MapSource {
  public:
    Source(runtime::Device& device, const VwssSettings& settings, const runtime::Program& program)
        : device_(&device),
          settings_(settings),
          points_(program, settings.cull, settings.precision),
          warp_(program, settings.parallelism, settings.viewsPerPass) {
        points_.grow(1);
    }

    void begin(const Inputs& inputs, LightView& view, Buffer<float>& samples,
               Buffer<shared::MultiViewCounters>& counters) override {
        if (view.density < settings_.density * 0.999)
            warnings.push_back(fmt::format(
                "light '{}': the enlarged view is capped at {} pixels: density {:.2f} of {:.2f}; "
                "use a smaller resolution or a larger near=",
                inputs.light.name, view.params.enlarged, view.density, settings_.density));
        points_.adapt(inputs.mesh, view);
        mesh_ = &inputs.mesh;
        view_ = &view;
        samples_ = &samples;
        counters_ = &counters;
        counterList_.push_back(&counters);
        if (!settings_.buffered) return;
        device_->profiler().beginStage("points");
        points_.run(inputs.mesh, view, counters);
    }

    void fill(const MapBatch& batch) override {
        if (settings_.buffered) {
            warp_.run(points_.buffers(), *view_, *samples_, batch, *counters_);
            return;
        }
        batch.maps32->fill(0, static_cast<std::uint64_t>(view_->params.mapStride) *
                                  static_cast<std::uint64_t>(batch.viewCount));
        shared::LookupParams views{};
        views.mapView = batch.firstView;
        const int step = warp_.viewsPerLaunch(batch.viewCount);
        for (int first = 0; first < batch.viewCount; first += step) {
            views.firstView = batch.firstView + first;
            views.viewCount = std::min(step, batch.viewCount - first);
            points_.runDirect(*mesh_, *view_, views, *samples_, *batch.maps32, *counters_);
        }
    }

    std::uint64_t keyBytes(const Mesh& mesh) const { return points_.keyBytes(mesh); }

    double density() const override { return settings_.density; }

    bool needsWideMaps() const override { return !settings_.buffered || warp_.needsWideMaps(); }

    bool grew() override {
        std::uint64_t most = 0;
        for (const auto* counters : counterList_)
            most = std::max<std::uint64_t>(most, counters->download()[0].points);
        counterList_.clear();
        const bool points = settings_.buffered && points_.grow(most);
        return points_.grewTiles() || points;
    }

    std::vector<std::string> warnings;  ///< of the frame

  private:
    runtime::Device* device_;
    VwssSettings settings_;
    Points points_;
    DepthWarp warp_;
    const Mesh* mesh_ = nullptr;
    LightView* view_ = nullptr;
    Buffer<float>* samples_ = nullptr;
    Buffer<shared::MultiViewCounters>* counters_ = nullptr;
    std::vector<Buffer<shared::MultiViewCounters>*> counterList_;
};

Vwss::Vwss(const TechniqueContext& context)
    : settings_(parseSettings<VwssSettings>("vwss", context.values)),
      program_(context.device, "multi_view"),
      multiView_(program_, settings_, context.width, context.height, context.fragmentRows),
      reader_(program_, {settings_.pcf, settings_, false}),
      source_(std::make_unique<Source>(context.device, settings_, program_)) {}

std::uint64_t Vwss::plannedBytes(const TechniqueContext& context) {
    const auto settings = parseSettings<VwssSettings>("vwss", context.values);
    return Points::plannedBytes(settings.precision) +
           MultiView::plannedBytes(settings, context.width, context.height);
}

Vwss::~Vwss() = default;

std::uint64_t Vwss::frameBytes(const Mesh& mesh) const {
    return multiView_.frameBytes(source_->needsWideMaps()) + source_->keyBytes(mesh);
}

void Vwss::run(const Inputs& inputs, Visibility& visibility) {
    multiView_.run(inputs, inputs.light, *source_, reader_, visibility);
}

bool Vwss::grew() {
    return source_->grew();
}

std::vector<std::string> Vwss::warnings() const {
    auto all = multiView_.warnings();
    all.insert(all.end(), source_->warnings.begin(), source_->warnings.end());
    return all;
}

Counts Vwss::takeCounts() {
    source_->warnings.clear();
    return multiView_.takeCounts();
}

}  // namespace penumbra::visibility
