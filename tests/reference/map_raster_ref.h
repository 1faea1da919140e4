// SPDX-License-Identifier: MIT
// Double-precision twin of kernels/visibility/map_raster.cl: a ray through each texel's centre.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/light.h"

namespace penumbra::tests {

/// What a depth map of one light sample holds at a texel.
struct MapTexel {
    double depth = 0;     ///< near / z of the nearest triangle; 0: none
    double margin = 1e9;  ///< texels to the nearest edge of any triangle: small ones may round away
};

/// Depth map [row, column] seen from light sample `sample`: `focal` texels per unit of tangent, the
/// light's axis at the centre of `size` texels. Triangles are three corners each, in the world.
std::vector<MapTexel> castMap(const scene::AreaLight& light, const glm::dvec2& sample,
                              const std::vector<glm::dvec3>& corners, double focal, double near,
                              int size);

}  // namespace penumbra::tests
