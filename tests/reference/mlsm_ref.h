// SPDX-License-Identifier: MIT
// Twins of kernels/visibility/mlsm_*.cl in double: fragments by cutting the lines through texel
// centres with triangles, merging by sorting all fragments of four lists, and the lookup as text.
#pragma once
#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.h"
#include "host/visibility/mlsm_filter.h"
#include "tests/reference/map_lookup_ref.h"

namespace penumbra::tests {

struct MlsmFragment {
    double depth = 0;  ///< near / z
    double coverage = 0;
    std::array<double, 3> taken{};  ///< per channel, times coverage; one channel: coverage
};
using MlsmList = std::vector<MlsmFragment>;

/// Lists [row, column] of what the light's centre sees of casters of one material without textures.
std::vector<MlsmList> mlsmBaseReference(const scene::Scene& scene, const scene::AreaLight& light,
                                        double near, double tanHalfFov, int resolution);

/// Sums two opacities of one list: shared::MLSM_*.
MlsmFragment mlsmSumReference(int how, const MlsmFragment& sum, const MlsmFragment& more);

/// A level from the one below. epsilon: of the level, share of the depth.
std::vector<MlsmList> mlsmMergeReference(const std::vector<MlsmList>& below, int belowSize,
                                         const shared::MlsmFilterParams& step, int size,
                                         double epsilon, int how);

struct MlsmLookupReference {
    double reach = 0;  ///< base texels of filter per unit of depth
    double stepX = 0, stepY = 0;
    int parts = 1;
    bool multiply = false;
    double constantTexels = 0.25, slopeBias = 0;
};

/// Visibility per channel of a receiver.
std::array<double, 3> mlsmVisibilityReference(const PlaneReceiver& receiver,
                                              const ViewGeometry& view,
                                              const visibility::MlsmLevels& levels,
                                              const std::vector<std::vector<MlsmList>>& lists,
                                              const MlsmLookupReference& settings);

}  // namespace penumbra::tests
