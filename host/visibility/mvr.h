// SPDX-License-Identifier: MIT
// Multi-view rasterisation [VWSS] 2.1, 4: every triangle into the depth map of every light sample.
// The rival of vwss: maps are exact up to texels and bias, and filtered by the same MultiView.
#pragma once
#include "host/visibility/map_lookup.h"
#include "host/visibility/map_raster.h"

namespace penumbra::visibility {

struct MvrSettings : MultiViewSettings {
    MapForm form = MapForm::full;
    Coverage coverage = Coverage::standard;
    Cull cull = Cull::automatic;

    template <typename Row>
    void rows(Row& row) {
        MultiViewSettings::rows(row);
        row.choice("form", form, {"full", "textbook"},
                   "vertices projected and triangles culled once for all views, or all work anew "
                   "for each view; never changes the image");
        row.choice("coverage", coverage, {"standard", "conservative"},
                   "texels that a triangle covers: whose centre it holds, or all that it touches");
        row.choice("cull", cull, {"auto", "back", "front", "none"},
                   "faces that are not drawn; auto: back faces of edge-closed meshes");
    }
};

class Mvr : public Technique {
  public:
    explicit Mvr(const TechniqueContext& context);
    static std::uint64_t plannedBytes(const TechniqueContext& context);
    std::uint64_t frameBytes(const Mesh& mesh) const override {
        return multiView_.frameBytes(source_.needsWideMaps()) + source_.frameBytes(mesh);
    }
    void run(const Inputs& inputs, Visibility& visibility) override {
        multiView_.run(inputs, inputs.light, source_, reader_, visibility);
    }
    bool grew() override { return source_.grew(); }
    Counts takeCounts() override;
    std::vector<SettingRow> settings() const override { return settingsInForce(settings_); }
    std::vector<std::string> warnings() const override { return multiView_.warnings(); }

  private:
    MvrSettings settings_;
    runtime::Program shared_, program_;
    MultiView multiView_;
    MapRaster source_;
    MapLookup reader_;
};

}  // namespace penumbra::visibility
