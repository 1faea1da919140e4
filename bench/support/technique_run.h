// SPDX-License-Identifier: MIT
// A technique on a posed scene at 1280 x 720, for benchmarks of its stages.
#pragma once
#include <map>

#include "bench/support/bench.h"
#include "host/gbuffer/gbuffer.h"
#include "host/scene/camera.h"
#include "host/visibility/technique.h"

namespace penumbra::bench {

/// A dozen quads as large as the field of view, one behind the other, over a floor: few triangles
/// that cover many texels.
PosedScene& wallScene();

class TechniqueRun {
  public:
    /// `samples` samples of the scene's light; repeats until no list is too short.
    TechniqueRun(PosedScene& posed, const std::string& technique, const SettingValues& settings,
                 int samples, scene::Pattern pattern = scene::Pattern::hammersley);
    /// One run: milliseconds of the device by stage; counts of it.
    std::map<std::string, double> stages();
    const visibility::Counts& counts() const { return counts_; }
    /// Receivers that are tested.
    std::int64_t tested() const { return tested_; }

  private:
    void enqueue();
    PosedScene* posed_;
    scene::AreaLight light_;
    gbuffer::GBufferPass pass_;
    std::unique_ptr<visibility::Technique> technique_;
    visibility::Visibility visibility_;
    visibility::Counts counts_;
    std::int64_t tested_ = 0;
};

}  // namespace penumbra::bench
