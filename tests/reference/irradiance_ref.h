// SPDX-License-Identifier: MIT
// Twin of kernels/lib/area_light.h by numerical integration in double.
#pragma once
#include <glm/glm.hpp>

#include "host/scene/light.h"

namespace penumbra::tests {

/// Integral over the light of max(cos at the receiver, 0) max(cos at the light, 0) / r^2 by the
/// midpoint rule with steps^2 cells (disks in polar coordinates): irradiance for radiance 1.
double irradianceReference(const scene::AreaLight& light, const glm::dvec3& point,
                           const glm::dvec3& normal, int steps = 400);

}  // namespace penumbra::tests
