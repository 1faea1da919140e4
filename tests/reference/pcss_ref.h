// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/pcss.cl in double: taps are points in space on the line from the
// receiver to a light sample, projected into the map; the receiver's plane is cut with each texel's
// ray.
#pragma once
#include <vector>

#include "tests/reference/map_lookup_ref.h"

namespace penumbra::tests {

struct PcssReference {
    LookupSettings bias;     ///< slopeBias, constantTexels, constantMetres
    bool planeBias = true;   ///< taps compare with the receiver's plane, else with its depth
    double leastSpread = 0;  ///< of near / distance between receiver and filter
    glm::dvec2 halfSize{0};  ///< metres: of the ellipse of light samples
    double angle = 0;        ///< that the patterns are turned by
    std::vector<glm::dvec2> search, filter;  ///< taps in the unit disk
};

struct PcssOutcome {
    HiddenWeight hidden;  ///< of filter.size() taps
    bool certain = true;  ///< false: float may find other blockers, anything goes
    double blocker = 0;   ///< mean distance of the blockers; 0: none
};

/// map: depths [row, column] of the view from the light's centre.
PcssOutcome pcssReference(const PlaneReceiver& receiver, const ViewGeometry& view,
                          const std::vector<double>& map, const PcssReference& settings);

}  // namespace penumbra::tests
