// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/mlsm_lists.cl in double: fragments by cutting the lines through texel
// centres with triangles.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/light.h"
#include "host/scene/scene.h"

namespace penumbra::tests {

struct MlsmFragment {
    double depth = 0;  ///< near / z
    double coverage = 0;
    std::array<double, 3> taken{};  ///< per channel, times coverage; one channel: coverage
};
using MlsmList = std::vector<MlsmFragment>;

MlsmFragment scaled(const MlsmFragment& f, double weight);
void add(MlsmFragment& sum, const MlsmFragment& more);

/// Lists [row, column] of what the light's centre sees of casters of one material without textures.
std::vector<MlsmList> mlsmBaseReference(const scene::Scene& scene, const scene::AreaLight& light,
                                        double near, double tanHalfFov, int resolution);

}  // namespace penumbra::tests
