// SPDX-License-Identifier: MIT
// View-warped multi-view soft shadows [VWSS] 3: casters are rasterised once into points, which are
// warped into one depth map per light sample.
#pragma once
#include "host/visibility/depth_warp.h"
#include "host/visibility/map_lookup.h"
#include "host/visibility/points.h"

namespace penumbra::visibility {

struct VwssSettings : MultiViewSettings {
    Cull cull = Cull::automatic;
    float density = 1;
    Precision precision = Precision::single;
    Parallelism parallelism = Parallelism::automatic;
    int viewsPerPass = 8;
    bool buffered = true;

    template <typename Row>
    void rows(Row& row) {
        MultiViewSettings::rows(row);
        row.choice("cull", cull, {"auto", "back", "front", "none"},
                   "faces that make no points; auto: back faces of edge-closed meshes");
        row.number("density", density, 0.1F, 8.0F, "",
                   "pixels of the enlarged view per texel of a map, times [VWSS] equation 3");
        row.choice("precision", precision, {"float", "half", "fixed"},
                   "of stored points: 12, 6 or 6 bytes each");
        row.choice("parallelism", parallelism, {"auto", "serial", "partial", "full", "owned"},
                   "maps per traversal of the points: one, viewsPerPass, all, or all with a map "
                   "per work-item; never changes the image");
        row.number("viewsPerPass", viewsPerPass, 1, 4096, "views",
                   "maps per traversal with parallelism partial", false);
        row.flag("buffered", buffered,
                 "keep points in a buffer; false: splat fragments as they are rasterised");
    }
};

class Vwss : public Technique {
  public:
    explicit Vwss(const TechniqueContext& context);
    static std::uint64_t plannedBytes(const TechniqueContext& context);
    ~Vwss() override;
    std::uint64_t frameBytes(const Mesh& mesh) const override;
    void run(const Inputs& inputs, Visibility& visibility) override;
    bool grew() override;
    Counts takeCounts() override;
    std::vector<SettingRow> settings() const override { return settingsInForce(settings_); }
    std::vector<std::string> warnings() const override;

  private:
    class Source;
    VwssSettings settings_;
    runtime::Program program_;
    MultiView multiView_;
    MapLookup reader_;
    std::unique_ptr<Source> source_;
};

}  // namespace penumbra::visibility
