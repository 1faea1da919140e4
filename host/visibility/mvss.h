// SPDX-License-Identifier: MIT
// Multi-view soft shadows as NVIDIA's sample has them [MVSS]: a few small maps at Poisson-disk
// samples, biased when they are written, one bilinear comparison each.
#pragma once
#include "host/visibility/map_lookup.h"
#include "host/visibility/map_raster.h"

namespace penumbra::visibility {

struct MvssSettings : MapSettings {
    MvssSettings() { resolution = 512; }
    int maps = 28;
    int seed = 0;
    float constantBias = 1e-4F, slopeBias = 2;
    MapForm form = MapForm::full;
    Cull cull = Cull::automatic;

    template <typename Row>
    void rows(Row& row) {
        row.number("maps", maps, 1, 4096, "maps",
                   "Poisson-disk samples of the light, whatever --light-samples says");
        row.number("seed", seed, 0, 1 << 30, "", "of the Poisson-disk samples");
        row.number("constantBias", constantBias, 0.0F, 1.0F, "near / z",
                   "taken from depths when maps are written");
        row.number("slopeBias", slopeBias, 0.0F, 64.0F, "",
                   "the same, times a surface's larger step of depth per texel");
        row.choice("form", form, {"full", "textbook"}, "as mvr.form; never changes the image");
        row.choice("cull", cull, {"auto", "back", "front", "none"},
                   "faces that are not drawn; auto: back faces of edge-closed meshes");
        MapSettings::rows(row);
    }
};

class Mvss : public Technique {
  public:
    explicit Mvss(const TechniqueContext& context);
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
    MvssSettings settings_;
    runtime::Program shared_, program_;
    MultiView multiView_;
    MapRaster source_;
    MapLookup reader_;
};

/// The light with the samples of mvss: those of `--light-pattern poisson` with its count and seed.
scene::AreaLight mvssLight(const scene::AreaLight& light, int maps, int seed);

}  // namespace penumbra::visibility
