// SPDX-License-Identifier: MIT
// Twin of kernels/shading/shade.cl in double, in world space. Reflection: Walter et al. 2007 (the
// GGX distribution, Smith's separable masking correlated by height as glTF 2.0 appendix B has it),
// Schlick 1994 (Fresnel). Diffuse: Lambert. Cones: KHR_lights_punctual.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/light.h"

namespace penumbra::tests {

struct ShadePixel {
    glm::dvec3 position{0}, geometric{0, 0, 1}, normal{0, 0, 1};
    glm::dvec3 albedo{0.5}, emissive{0};
    double metallic = 0, roughness = 1;
    bool unlit = false;
};

/// Reflected radiance per channel of one light, unshadowed, as a sum over the light's 16 fixed
/// points; `towardsEye` need not be of unit length.
glm::dvec3 reflectionReference(const scene::AreaLight& light, const ShadePixel& pixel,
                               const glm::dvec3& towardsEye);

/// The same as an integral over the light: the midpoint rule with steps^2 cells.
glm::dvec3 reflectionIntegral(const scene::AreaLight& light, const ShadePixel& pixel,
                              const glm::dvec3& towardsEye, int steps);

/// All that a light adds to a pixel: Lambert's integral and the reflection, in the cone, times
/// visibility; 0 where the whole light lies behind the pixel's geometric plane.
glm::dvec3 shadeReference(const scene::AreaLight& light, const ShadePixel& pixel,
                          const glm::dvec3& towardsEye, const glm::dvec3& visibility);

}  // namespace penumbra::tests
