// SPDX-License-Identifier: MIT
// Twin of kernels/lib/area_light.h by numerical integration in double, and closed forms where
// receivers face the light squarely.
#pragma once
#include <glm/glm.hpp>

#include "host/scene/light.h"

namespace penumbra::tests {

/// Integral over the light of max(cos at the receiver, 0) max(cos at the light, 0) / r^2 by the
/// midpoint rule with steps^2 cells (disks in polar coordinates): irradiance for radiance 1.
double irradianceReference(const scene::AreaLight& light, const glm::dvec3& point,
                           const glm::dvec3& normal, int steps = 400);

/// Irradiance for radiance 1 of a receiver parallel to the light, `offset` from its axis (along the
/// light's axes) and `distance` before it, in closed form. Howell, A Catalog of Radiation Heat
/// Transfer Configuration Factors, 3rd edition: B-3 (corners of a rectangle), B-12 (a disk).
double parallelIrradiance(const scene::AreaLight& light, const glm::dvec2& offset, double distance);

/// The same of a receiver whose plane contains the light's axis and which looks along axisX, for
/// a rectangle with an edge in that plane (from 0 to width along axisX, both ways along axisY).
/// Howell: B-4.
double perpendicularIrradiance(double width, double height, double distance);

}  // namespace penumbra::tests
