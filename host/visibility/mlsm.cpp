// SPDX-License-Identifier: MIT
#include "host/visibility/mlsm.h"

#include <cmath>

#include "host/visibility/single_view.h"
#include "kernels/shared/gbuffer.h"
#include "runtime/profiler.h"

namespace penumbra::visibility {

/// Makes the lists of all levels.
class Mlsm::Source : public MapSource {
  public:
    Source(const runtime::Program& frame, const runtime::Program& mlsm,
           const MlsmSettings& settings)
        : device_(&mlsm.device()),
          settings_(settings),
          lists(frame, mlsm, settings),
          filter_(mlsm) {}

    void begin(const Inputs& inputs, LightView& view, Buffer<float>&,
               Buffer<shared::MultiViewCounters>& counters) override {
        mesh_ = &inputs.mesh;
        view_ = &view;
        counters_ = &counters;
        reach = mlsmReachOf(view);
        levels = planMlsmLevels(settings_, reach.size);
        levels.params.channels = mesh_->hasBlend ? 3 : 1;
        levels.params.accumulate =
            accumulationOf(settings_.accumulateMerge, mesh_->hasMask, MLSM_COVER);
        accumulate = accumulationOf(settings_.accumulateLookup, mesh_->hasMask, MLSM_ADD);
        // A texel's side is near / focal of its distance: the share of near / z that depth falls by
        // over one
        levels.params.epsilon = settings_.epsilon / view.params.focal;
    }
    bool makesMaps() const override { return false; }
    void fill(const MapBatch&) override {
        lists.run(*mesh_, *view_, levels.params, *counters_);
        device_->profiler().beginStage("filtering");
        filter_.run(levels, lists.map());
    }
    bool needsWideMaps() const override { return false; }
    bool grew() override { return lists.grew(); }

  private:
    runtime::Device* device_;
    MlsmSettings settings_;
    const Mesh* mesh_ = nullptr;
    const LightView* view_ = nullptr;
    Buffer<shared::MultiViewCounters>* counters_ = nullptr;

  public:
    MlsmLists lists;
    MlsmLevels levels;
    MlsmReach reach;
    int accumulate = MLSM_ADD;  ///< in the lookup

  private:
    MlsmFilter filter_;
};

class Mlsm::Reader : public MapReader {
  public:
    Reader(const runtime::Program& mlsm, const MlsmSettings& settings, Source& source)
        : source_(&source), lookup_(mlsm, settings) {}

    int channels() const override { return source_->levels.params.channels; }
    int weight() const override { return MLSM_WEIGHT; }
    void read(const LightView& view, const MapBatch&, ReceiverImage& receivers) override {
        lookup_.run(view, source_->reach, source_->accumulate, source_->levels.params,
                    source_->lists.map(), receivers);
    }

  private:
    Source* source_;
    MlsmLookup lookup_;
};

Mlsm::Mlsm(const TechniqueContext& context)
    : settings_(parseSettings<MlsmSettings>("mlsm", context.values)),
      frame_(context.device, "frame"),
      shared_(context.device, "multi_view"),
      program_(context.device, "mlsm"),
      multiView_(shared_, settings_, context.width, context.height, context.fragmentRows),
      source_(std::make_unique<Source>(frame_, program_, settings_)),
      reader_(std::make_unique<Reader>(program_, settings_, *source_)),
      receivers_(
          static_cast<std::uint64_t>(shared::gbufferStride(context.width * context.height))) {}

Mlsm::~Mlsm() = default;

std::uint64_t Mlsm::plannedBytes(const TechniqueContext& context) {
    const auto settings = parseSettings<MlsmSettings>("mlsm", context.values);
    const auto size = static_cast<std::uint64_t>(settings.resolution);
    // Counts, first fragments, lists of 4/3 levels and room for two fragments a texel
    return MultiView::plannedBytes(settings, context.width, context.height) +
           size * size * (4 + 4 + 16 + 16);
}

std::uint64_t Mlsm::frameBytes(const Mesh& mesh) const {
    const auto lists = planMlsmLevels(settings_, HUGE_VAL).lists;
    const std::uint64_t colour = mesh.hasBlend ? 3 * receivers_ * sizeof(std::uint32_t) : 0;
    return source_->lists.frameBytes(mesh, lists) + colour + 4096;
}

void Mlsm::run(const Inputs& inputs, Visibility& visibility) {
    multiView_.run(inputs, centralView(inputs.light), *source_, *reader_, visibility);
}

bool Mlsm::grew() {
    return source_->grew();
}

Counts Mlsm::takeCounts() {
    Counts counts = multiView_.takeCounts();
    counts.points = source_->lists.takeFragments();
    return counts;
}

}  // namespace penumbra::visibility
