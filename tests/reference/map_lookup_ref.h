// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/map_lookup.cl in double. Depths of the receiver's plane come from
// cutting the ray of each texel's centre with the plane, not from gradients.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/multi_view.h"

namespace penumbra::tests {

/// A receiver in the light's frame: where its shadow tests start, and the geometric normal there.
struct PlaneReceiver {
    glm::dvec3 origin{0}, normal{0, 0, -1};
};

/// The views of a light.
struct ViewGeometry {
    double tanHalfFov = 1, near = 1, halfWidth = 0, halfHeight = 0;
    int resolution = 64;
    double focal() const { return resolution / (2 * tanHalfFov); }
};

struct ReceiverReference {
    std::uint32_t state = STATE_MASKED;  ///< STATE_MASKED, STATE_TESTED or STATE_LIT
    bool outside = false;                ///< some view of the light's rectangle does not hold it
    double doubt = 1;  ///< least margin of the decisions above: metres, or texels for `outside`
    double a = 0, b = 0, w = 0;
    double slopeX = 0, slopeY = 0;  ///< near n / F
    double facing = 0;              ///< -n . origin
};

ReceiverReference receiverReference(const PlaneReceiver& receiver, const ViewGeometry& view,
                                    bool covered, bool receives);

struct LookupSettings {
    int pcf = 5;  ///< 1, 5, 9; 4: bilinear
    double slopeBias = 1, constantTexels = 0, constantMetres = 0, quantum = 0;
};

/// Weight of the hidden tests of one view: of 1, 5, 9 or (bilinear) 256. Where float may decide
/// otherwise, low and high differ.
struct HiddenWeight {
    int low = 0, high = 0;
};

/// map: depths [row, column] of the view of the light sample at (sample.x, sample.y, 0).
HiddenWeight hiddenReference(const PlaneReceiver& receiver, const ViewGeometry& view,
                             const glm::dvec2& sample, const std::vector<double>& map,
                             const LookupSettings& settings);

/// A pixel of an image as upsampling sees it.
struct UpsamplePixel {
    glm::dvec3 position{0}, normal{0, 1, 0};
    bool tested = false;
    double value = 1;  ///< known at even columns and rows
};

/// Value of pixel (column, row): mean of the tested pixels of even column and row less than two
/// pixels away on each axis, weighted by tents of that width and by how much they lie on the same
/// surface (normals within cos 0.8, off the plane by less than a quarter of the distance); where
/// none does, of the nearest one; 1 without any.
double upsampleReference(const std::vector<UpsamplePixel>& image, int width, int height, int column,
                         int row);

}  // namespace penumbra::tests
