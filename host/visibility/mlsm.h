// SPDX-License-Identifier: MIT
// Filtered multi-layer shadow maps [MLSM]: all fragments that the light's centre sees through,
// filtered beforehand, looked up at the filter size that each depth asks for.
#pragma once
#include "host/visibility/mlsm_lookup.h"

namespace penumbra::visibility {

class Mlsm : public Technique {
  public:
    explicit Mlsm(const TechniqueContext& context);
    ~Mlsm() override;
    static std::uint64_t plannedBytes(const TechniqueContext& context);
    int channels(const Mesh& mesh) const override { return mesh.hasBlend ? 3 : 1; }
    bool hasDepthMaps() const override { return false; }
    std::uint64_t frameBytes(const Mesh& mesh) const override;
    void run(const Inputs& inputs, Visibility& visibility) override;
    bool grew() override;
    Counts takeCounts() override;
    std::vector<SettingRow> settings() const override { return settingsInForce(settings_); }
    std::vector<std::string> warnings() const override { return multiView_.warnings(); }

  private:
    class Source;
    class Reader;
    MlsmSettings settings_;
    runtime::Program frame_, shared_, program_;
    MultiView multiView_;
    std::unique_ptr<Source> source_;
    std::unique_ptr<Reader> reader_;
    std::uint64_t receivers_;  ///< slots of the image of receivers
};

}  // namespace penumbra::visibility
