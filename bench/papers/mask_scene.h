// SPDX-License-Identifier: MIT
// One frame of a scene, its pixels and its light, for techniques that are timed or compared by
// themselves.
#pragma once
#include <map>
#include <memory>

#include "host/gbuffer/gbuffer.h"
#include "host/scene/animation.h"
#include "host/scene/light.h"
#include "host/visibility/technique.h"

namespace penumbra::papers {

/// How a frame is looked at and lit.
struct MaskView {
    int size = 512;  ///< pixels on a side
    std::string samples = "32x32";
    double seconds = 0;
    double turnRad = 0;     ///< of the camera about the scene's centre
    double lightScale = 1;  ///< times the light's sides
};

class MaskScene {
  public:
    MaskScene(runtime::Device& device, const std::string& file, const MaskView& view);
    /// Device milliseconds by stage: of each the median of `repeats` runs after one that counts for
    /// nothing.
    std::map<std::string, double> run(const std::string& technique, const SettingValues& settings,
                                      int repeats, visibility::OcclusionMasks* masks = nullptr);

    const scene::AreaLight& light() const { return light_; }
    const scene::Bounds& bounds() const { return bounds_; }
    const geometry::Mesh& mesh() const { return geometry_.mesh(); }
    double radius() const { return bounds_.radius(); }
    std::uint32_t triangles() const { return geometry_.mesh().casterTriangleCount; }
    /// Corners of casters, three a triangle; re-based world, as the device posed them.
    std::vector<glm::vec3> corners() const;
    /// Where shadow rays start, with the geometric normal: of each pixel that is tested.
    struct Receiver {
        glm::vec3 origin, normal;
        std::size_t pixel;
    };
    std::vector<Receiver> receivers() const;
    std::vector<glm::dvec3> samplePoints() const;

  private:
    runtime::Device* device_;
    scene::Scene scene_;
    scene::Bounds bounds_;
    runtime::Program frame_;
    geometry::Geometry geometry_;
    gbuffer::GBufferPass pass_;
    scene::AreaLight light_;
    visibility::Visibility visibility_;
    int size_;
};

}  // namespace penumbra::papers
