// SPDX-License-Identifier: MIT
#include "tests/reference/abuffer_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

constexpr double kOpaqueAlpha = 0.9999, kDoubt = 2e-3;

}  // namespace

ABufferReference::ABufferReference(const scene::Scene& scene, const scene::CameraFrame& camera,
                                   int width, int height)
    : triangles_(flatTriangles(scene)),
      raster_(scene, camera, width, height),
      surfaces_(scene, scene, camera, width, height) {}

const scene::Material& ABufferReference::materialOf(int triangle) const {
    return *triangles_[static_cast<std::size_t>(triangle)].material;
}

std::vector<BlendedFragment> ABufferReference::list(int column, int row) const {
    std::vector<BlendedFragment> blended;
    double opaque = 0, slack = 0;  // of the nearest opaque surface
    const auto behind = [&](const RasterFragment& f) {
        if (f.depth <= opaque) return;
        opaque = f.depth;
        slack = f.slack;
    };
    for (const auto& f : raster_.covering(column, row)) {
        const auto& material = materialOf(f.triangle);
        const bool blends =
            material.alphaMode == scene::AlphaMode::blend ||
            (material.transmission > 0 && material.alphaMode == scene::AlphaMode::opaque);
        if (!blends) continue;
        BlendedFragment fragment{f};
        const auto surface = surfaces_.surface(f.triangle, column, row, 0);
        fragment.alpha = surface.alpha;
        fragment.through = surface.through;
        const bool filters = material.transmission > 0;
        if (!filters && fragment.alpha >= kOpaqueAlpha) {
            behind(f);
            continue;
        }
        // A texture's alpha is off by what float uvs are
        const bool varies = material.baseColorTexture.image >= 0;
        fragment.doubtful = varies && (fragment.alpha < kDoubt ||
                                       (!filters && fragment.alpha > kOpaqueAlpha - kDoubt));
        if (fragment.alpha > 0) blended.push_back(fragment);
    }
    for (const auto& f : raster_.fragments(column, row))
        if (materialOf(f.triangle).alphaMode != scene::AlphaMode::blend) behind(f);
    std::erase_if(blended, [&](auto& f) {
        f.doubtful |= std::abs(f.depth - opaque) < f.slack + slack;
        return !f.doubtful && f.depth < opaque;
    });
    std::stable_sort(blended.begin(), blended.end(),
                     [](const auto& a, const auto& b) { return a.depth > b.depth; });
    return blended;
}

}  // namespace penumbra::tests
