// SPDX-License-Identifier: MIT
// Shades hand-made pixels on the device.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/light.h"
#include "tests/reference/shade_ref.h"

namespace penumbra::tests {

struct Receiver {
    glm::dvec3 point, normal;
};

/// What shading gives per pixel. `visibility` [pixel] per channel; `eye`: the camera's place.
std::vector<glm::dvec3> shadePixels(const std::vector<ShadePixel>& pixels,
                                    const scene::AreaLight& light, const glm::dvec3& eye,
                                    const glm::dvec3& ambient, int channels,
                                    const std::vector<glm::dvec3>& visibility);

/// Irradiance for radiance 1: reflections do not depend on the albedo of a dielectric, so two
/// albedos differ by the diffuse part alone.
std::vector<double> irradiance(const std::vector<Receiver>& receivers,
                               const scene::AreaLight& light);

/// A light that leans, for receivers about the origin.
scene::AreaLight makeLight(bool disk, double width, double height);

}  // namespace penumbra::tests
