// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/essm.cl in double: e^(c d) by the library, slopes and the receiver's
// plane from cutting rays with it, the level of a filter by logarithm.
#pragma once
#include <vector>

#include "tests/reference/map_lookup_ref.h"

namespace penumbra::tests {

/// One level of the pyramid: [row, column].
struct EssmLevel {
    int size = 0;
    std::vector<double> exponentials, depths;
};

struct EssmReference {
    double exponent = 80;
    double nearZ = 1, range = 1;  ///< metres: warped depth is 0 at nearZ, 1 at nearZ + range
    double leak = 0;              ///< visibility up to this becomes 0
    double constantTexels = 0, constantMetres = 0;
    double leastRadius = 0.75;  ///< texels
    glm::dvec2 halfSize{0};     ///< metres: of the light's square
};

/// Level 0 from depths near / z of casters and receivers, 0: nothing there; each next level holds
/// the means of 2 x 2 texels, an odd level's last row and column counted twice.
std::vector<EssmLevel> essmPyramid(const std::vector<double>& casters,
                                   const std::vector<double>& receivers, int size, double near,
                                   const EssmReference& settings);

/// Visibility by Shen et al.: boxes of 8 x 8 texels, between the two levels whose texels are about
/// as large as a tap's share of the box. Where a tap lies within 2e-4 texels of a border, float may
/// read the neighbour: `certain` is false.
struct EssmOutcome {
    double visibility = 1;
    bool certain = true;
};
EssmOutcome essmReference(const PlaneReceiver& receiver, const ViewGeometry& view,
                          const std::vector<EssmLevel>& pyramid, const EssmReference& settings);

}  // namespace penumbra::tests
