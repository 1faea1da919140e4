// SPDX-License-Identifier: MIT
// Twin of kernels/shading/composite.cl in double, from the farthest layer to the nearest: what is
// behind passes through a layer's filter, and the layer's own light is added.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace penumbra::tests {

struct Layer {
    glm::dvec3 colour{0};
    double alpha = 1;
    glm::dvec3 through{0};
};

struct Composited {
    glm::dvec3 colour{0};
    double alpha = 0;  ///< share that is covered
    int front = -1;    ///< first layer of an alpha above 0.5; -1: the opaque surface
};

/// `layers`: from the nearest to the farthest.
Composited compositeReference(const std::vector<Layer>& layers, const glm::dvec3& opaque,
                              bool covered);

}  // namespace penumbra::tests
