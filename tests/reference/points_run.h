// SPDX-License-Identifier: MIT
// Runs geometry and point generation for a scene at rest and one light, and brings points to the
// host.
#pragma once
#include <vector>

#include "host/scene/animation.h"
#include "host/scene/bounds.h"
#include "host/scene/light.h"
#include "host/visibility/depth_warp.h"
#include "host/visibility/points.h"

namespace penumbra::tests {

/// A point as depth_warp decodes it.
struct DevicePoint {
    double a = 0, b = 0, w = 0;
    std::uint32_t key = 0;
};

struct PointsSetup {
    std::string light = "rect:at=0.3,6,-0.4;aim=0,0,0;size=1.2x0.8;radiance=10";
    std::string samples = "4";
    int resolution = 200;
    double density = 1;
    visibility::Cull cull = visibility::Cull::none;
    visibility::Precision precision = visibility::Precision::single;
};

class PointsRun {
  public:
    PointsRun(const scene::Scene& original, const PointsSetup& setup);
    std::vector<DevicePoint> points() const;
    /// Depth maps [view] of the stored points: resolution^2 depths each, of 16 or 32 bits a texel.
    std::vector<std::vector<float>> warpedMaps(visibility::Parallelism form, int bits);
    /// Depth maps [view] straight from the rasteriser: resolution^2 float bits each.
    std::vector<std::vector<float>> directMaps();

    scene::Scene scene;
    scene::Bounds bounds;
    scene::Pose pose;
    scene::AreaLight light;
    visibility::LightView view;
    shared::MultiViewCounters counters{};

  private:
    geometry::Geometry geometry_;
    visibility::Points pass_;
};

}  // namespace penumbra::tests
