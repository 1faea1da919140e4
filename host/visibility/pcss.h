// SPDX-License-Identifier: MIT
// Percentage-closer soft shadows (Fernando 2005), the rival of [VWSS] 4: one map, blocker search,
// percentage-closer filter.
#pragma once
#include "host/visibility/map_lookup.h"
#include "host/visibility/map_raster.h"
#include "kernels/shared/single_view.h"

namespace penumbra::visibility {

enum class DiskPattern { vogel, poisson };

struct PcssSettings : MapSettings, BiasSettings {
    int blockerTaps = 64, filterTaps = 96;
    DiskPattern pattern = DiskPattern::vogel;
    bool rotate = true, planeBias = true;
    Cull cull = Cull::automatic;

    template <typename Row>
    void rows(Row& row) {
        row.number("blockerTaps", blockerTaps, 1, 1024, "taps", "of the blocker search");
        row.number("filterTaps", filterTaps, 1, 1024, "taps", "of the percentage-closer filter");
        row.choice("pattern", pattern, {"vogel", "poisson"}, "of the taps in their disk");
        row.flag("rotate", rotate, "turn the pattern from pixel to pixel: noise in place of bands");
        row.flag("planeBias", planeBias,
                 "compare taps with the receiver's plane, not with its depth");
        row.choice("cull", cull, {"auto", "back", "front", "none"},
                   "faces that are not drawn; auto: back faces of edge-closed meshes");
        pixelRows(row);
        BiasSettings::rows(row);
    }
};

/// Tests receivers against the one map. Kernel: kernels/visibility/pcss.cl
class PcssReader : public MapReader {
  public:
    PcssReader(const runtime::Program& program, const PcssSettings& settings);
    int weight() const override { return settings_.filterTaps; }
    void read(const LightView& view, const MapBatch& batch, ReceiverImage& receivers) override;

  private:
    runtime::Device* device_;
    PcssSettings settings_;
    runtime::Kernel<shared::MultiViewParams, shared::LookupParams, shared::PcssParams, int,
                    Buffer<float>, Buffer<float>, Buffer<float>, Buffer<std::uint32_t>,
                    Buffer<std::uint32_t>>
        pcss_;
    Buffer<float> patterns_, rotations_;
};

class Pcss : public Technique {
  public:
    explicit Pcss(const TechniqueContext& context);
    static std::uint64_t plannedBytes(const TechniqueContext& context);
    std::uint64_t frameBytes(const Mesh& mesh) const override {
        return multiView_.frameBytes(source_.needsWideMaps()) + source_.frameBytes(mesh);
    }
    void run(const Inputs& inputs, Visibility& visibility) override;
    bool grew() override { return source_.grew(); }
    Counts takeCounts() override;
    std::vector<SettingRow> settings() const override { return settingsInForce(settings_); }
    std::vector<std::string> warnings() const override { return multiView_.warnings(); }

  private:
    PcssSettings settings_;
    runtime::Program shared_, maps_, program_;
    MultiView multiView_;
    MapRaster source_;
    PcssReader reader_;
};

}  // namespace penumbra::visibility
