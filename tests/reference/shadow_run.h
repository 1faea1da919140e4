// SPDX-License-Identifier: MIT
// Runs the passes up to visibility for one scene and one light and brings everything to the host.
//   scene, camera, light -> geometry -> gbuffer -> vwss -> planes, visibility, states, depth maps
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/scene/animation.h"
#include "host/scene/bounds.h"
#include "host/scene/light.h"
#include "host/settings.h"
#include "host/visibility/technique.h"

namespace penumbra::tests {

struct ShadowSetup {
    std::string technique = "vwss";
    SettingValues settings;      ///< "vwss.resolution" -> "256"
    std::string samples = "64";  ///< as --light-samples
    scene::Pattern pattern = scene::Pattern::hammersley;
    std::uint32_t seed = 0;  ///< as --seed
    std::string light;       ///< as --light; empty: the scene's first
    glm::dvec3 eye{0, 3, 6}, target{0};
    bool placedCamera = true;  ///< false: the scene's own camera
    double fovDegrees = 40;
    int width = 160, height = 120;
    double seconds = 0;
    bool keepMaps = false, keepMasks = false;
};

/// What one run gave; planes are those of kernels/shared/gbuffer.h.
struct ShadowRun {
    int width = 0, height = 0;
    std::size_t stride = 0;
    std::vector<float> planes, visibility;  ///< visibility: [channels, stride]
    std::vector<glm::vec3> casters;         ///< corners as the device posed them, three a triangle
    std::vector<std::uint32_t> state;
    visibility::DepthMaps maps;
    visibility::OcclusionMasks masks;
    visibility::Counts counts;
    int retries = 0;
    scene::AreaLight light;
    scene::Bounds bounds;
    scene::Pose pose;
    std::size_t pixels() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    bool tested(std::size_t pixel) const;
    bool covered(std::size_t pixel) const;
    glm::vec3 vectorAt(int plane, std::size_t pixel) const;  ///< three planes from `plane` on
    /// Where shadow rays start: re-based world, as kernels/lib/shadow_origin.h.
    glm::vec3 shadowOrigin(std::size_t pixel) const;
    /// Light samples in the re-based world.
    std::vector<glm::vec3> samplePoints() const;
};

ShadowRun runShadows(const scene::Scene& scene, const ShadowSetup& setup);

/// Root of the mean square difference over tested pixels.
double rmse(const ShadowRun& run, const std::vector<float>& truth);

}  // namespace penumbra::tests
