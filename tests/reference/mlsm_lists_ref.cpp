// SPDX-License-Identifier: MIT
#include "tests/reference/mlsm_lists_ref.h"

#include <algorithm>
#include <cmath>

#include "tests/reference/flat_scene.h"

namespace penumbra::tests {

MlsmFragment scaled(const MlsmFragment& f, double weight) {
    return {f.depth,
            f.coverage * weight,
            {f.taken[0] * weight, f.taken[1] * weight, f.taken[2] * weight}};
}

void add(MlsmFragment& sum, const MlsmFragment& more) {
    sum.coverage += more.coverage;
    for (std::size_t c = 0; c < 3; ++c) sum.taken[c] += more.taken[c];
}

namespace {

void sortLists(std::vector<MlsmList>& lists) {
    for (auto& list : lists)
        std::sort(list.begin(), list.end(), [](const MlsmFragment& a, const MlsmFragment& b) {
            return a.depth != b.depth ? a.depth > b.depth : a.taken < b.taken;
        });
}

/// Opacity of a material without textures.
MlsmFragment opacityOf(const scene::Material& m) {
    MlsmFragment f;
    f.coverage = 1;
    f.taken = {1, 1, 1};
    if (m.alphaMode == scene::AlphaMode::opaque && m.transmission == 0) return f;
    const double alpha = m.alphaMode == scene::AlphaMode::opaque ? 1 : m.baseColor.w;
    for (std::size_t c = 0; c < 3; ++c) {
        const double colour = m.baseColor[static_cast<glm::vec4::length_type>(c)];
        const double through = m.transmission > 0 ? 1 - alpha + alpha * m.transmission * colour
                                                  : (1 - alpha) * (1 - alpha + alpha * colour);
        f.taken[c] = 1 - through;
    }
    return f;
}

}  // namespace

std::vector<MlsmList> mlsmBaseReference(const scene::Scene& scene, const scene::AreaLight& light,
                                        double near, double tanHalfFov, int resolution) {
    std::vector<MlsmList> lists(static_cast<std::size_t>(resolution) * resolution);
    for (const auto& triangle : flatTriangles(scene)) {
        const int node = static_cast<int>(triangle.object) - 1;
        if (!scene.nodes[static_cast<std::size_t>(node)].castShadow) continue;
        for (std::size_t i = 0; i < lists.size(); ++i) {
            const double x = (static_cast<double>(i % resolution) + 0.5) / resolution * 2 - 1;
            const double y = (static_cast<double>(i / resolution) + 0.5) / resolution * 2 - 1;
            // Of length 1 along the light's axis
            const SightLine line{light.centre, light.axisZ + tanHalfFov * x * light.axisX +
                                                   tanHalfFov * y * light.axisY};
            const auto hit = hitPlane(triangle, line);
            const auto& w = hit.weights;
            if (!(hit.depth > 0) || std::min({w.x, w.y, w.z}) < 0) continue;
            auto fragment = opacityOf(*triangle.material);
            fragment.depth = std::min(near / hit.depth, 1.0);
            lists[i].push_back(fragment);
        }
    }
    sortLists(lists);
    return lists;
}

}  // namespace penumbra::tests
