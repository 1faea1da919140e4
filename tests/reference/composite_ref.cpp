// SPDX-License-Identifier: MIT
#include "tests/reference/composite_ref.h"

namespace penumbra::tests {

Composited compositeReference(const std::vector<Layer>& layers, const glm::dvec3& opaque,
                              bool covered) {
    Composited result;
    result.colour = opaque;
    glm::dvec3 background(covered ? 0 : 1);  // what shines through from behind everything
    for (auto i = layers.size(); i-- > 0;) {
        const Layer& layer = layers[i];
        result.colour = layer.alpha * layer.colour + layer.through * result.colour;
        background *= layer.through;
        if (layer.alpha > 0.5) result.front = static_cast<int>(i);
    }
    result.alpha = 1 - (background.x + background.y + background.z) / 3;
    return result;
}

}  // namespace penumbra::tests
