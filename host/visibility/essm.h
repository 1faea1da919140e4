// SPDX-License-Identifier: MIT
// Exponential soft shadow maps (Shen, Feng, Yang 2013), the rival of [MLSM] 8: one map of
// exponentials, filtered beforehand.
#pragma once
#include "host/visibility/map_lookup.h"
#include "host/visibility/map_raster.h"
#include "kernels/shared/single_view.h"

namespace penumbra::visibility {

struct EssmSettings : MapSettings {
    float exponent = 80;
    float leak = 0.05F;
    float bias = 0, constantBias = 0.25F;
    float leastRadius = 0.75F;
    Cull cull = Cull::automatic;

    template <typename Row>
    void rows(Row& row) {
        row.number("exponent", exponent, 1.0F, 86.0F, "",
                   "c of the warp e^(c d): larger leaks less and filters less smoothly");
        row.number("leak", leak, 0.0F, 0.9F, "", "visibility up to this becomes 0, against leaks");
        row.number("leastRadius", leastRadius, 0.0F, 64.0F, "texels",
                   "least half size of a filter");
        row.choice("cull", cull, {"auto", "back", "front", "none"},
                   "faces that are not drawn; auto: back faces of edge-closed meshes");
        pixelRows(row);
        row.number("bias", bias, 0.0F, 1e6F, "metres", "added to the automatic bias");
        row.number("constantBias", constantBias, 0.0F, 64.0F, "texels",
                   "automatic bias along the light, in footprints of a texel");
    }
};

/// The map of casters, the map of all receivers, and the pyramid of exponentials made of both.
/// Kernels: kernels/visibility/essm.cl
class EssmSource : public MapSource {
  public:
    EssmSource(const runtime::Program& mvr, const runtime::Program& essm,
               const EssmSettings& settings);
    void begin(const Inputs& inputs, LightView& view, Buffer<float>& samples,
               Buffer<shared::MultiViewCounters>& counters) override;
    void fill(const MapBatch& batch) override;
    bool needsWideMaps() const override { return true; }
    bool grew() override;
    /// Both maps' vertices, the receivers' map and the pyramid.
    std::uint64_t frameBytes(const Mesh& mesh) const;
    std::uint64_t takeTriangles();
    const shared::EssmParams& params() const { return params_; }
    const Buffer<float>& pyramid() const { return pyramid_; }

  private:
    runtime::Device* device_;
    EssmSettings settings_;
    MapRaster casters_, receivers_;
    runtime::Kernel<shared::MultiViewParams, shared::EssmParams, Buffer<std::uint32_t>,
                    Buffer<std::uint32_t>, Buffer<float>>
        base_;
    runtime::Kernel<shared::EssmParams, int, Buffer<float>> reduce_;
    Buffer<std::uint32_t> receiverMap_;
    Buffer<float> pyramid_;
    shared::EssmParams params_{};
    const LightView* view_ = nullptr;
};

class EssmReader : public MapReader {
  public:
    EssmReader(const runtime::Program& essm, const EssmSettings& settings,
               const EssmSource& source);
    int weight() const override { return 65535; }  // ESSM_WEIGHT
    void read(const LightView& view, const MapBatch& batch, ReceiverImage& receivers) override;

  private:
    runtime::Device* device_;
    EssmSettings settings_;
    const EssmSource* source_;
    runtime::Kernel<shared::MultiViewParams, shared::LookupParams, shared::EssmParams, int,
                    Buffer<float>, Buffer<float>, Buffer<std::uint32_t>>
        essm_;
};

class Essm : public Technique {
  public:
    explicit Essm(const TechniqueContext& context);
    static std::uint64_t plannedBytes(const TechniqueContext& context);
    std::uint64_t frameBytes(const Mesh& mesh) const override {
        return multiView_.frameBytes(true) + source_.frameBytes(mesh);
    }
    void run(const Inputs& inputs, Visibility& visibility) override;
    bool grew() override { return source_.grew(); }
    Counts takeCounts() override;
    std::vector<SettingRow> settings() const override { return settingsInForce(settings_); }
    std::vector<std::string> warnings() const override { return multiView_.warnings(); }

  private:
    EssmSettings settings_;
    runtime::Program shared_, maps_, program_;
    MultiView multiView_;
    EssmSource source_;
    EssmReader reader_;
};

}  // namespace penumbra::visibility
