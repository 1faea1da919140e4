// SPDX-License-Identifier: MIT
// Twin of kernels/gbuffer/gbuffer_resolve.cl in double, from glTF 2.0 (3.7, 3.9,
// KHR_texture_transform, KHR_materials_unlit): a pixel's line of sight is cut with the triangle's
// plane, and attributes are weighted by areas on that plane.
#pragma once
#include <map>
#include <memory>
#include <vector>

#include "tests/reference/flat_scene.h"
#include "tests/reference/texture_ref.h"

namespace penumbra::tests {

struct SurfaceReference {
    glm::dvec3 position{0}, previous{0};
    glm::dvec3 geometric{0}, normal{0};  ///< on the camera's side
    glm::dvec3 albedo{0}, emissive{0};
    double metallic = 0, roughness = 0, depth = 0;
    double alpha = 1;            ///< 1 where the material is OPAQUE
    glm::dvec3 through{0};       ///< share of what is behind that passes
    bool atTexelBorder = false;  ///< a small error would read another texel of a nearest filter
};

class ResolveReference {
  public:
    /// `last`: the scene as it was in the last frame; the same meshes, other matrices.
    ResolveReference(const scene::Scene& scene, const scene::Scene& last,
                     const scene::CameraFrame& camera, int width, int height);

    /// The triangle of a node that the pixel's centre sees: of those that face it, or, near an
    /// edge, miss it by the least. `margin`: its least barycentric weight.
    int triangleAt(std::uint32_t object, int column, int row, double& margin) const;
    /// `levelBias` is added to the logarithm that chooses a MIP level.
    SurfaceReference surface(int triangle, int column, int row, double levelBias) const;

  private:
    /// A texture read at the pixel, with the level of its footprint.
    struct Footprint {
        PlaneHit at, right, below;
        double levelBias;
    };
    const TextureReference& texture(const scene::TextureRef& use, bool srgb) const;
    glm::dvec4 read(const FlatTriangle& t, const scene::TextureRef& use, bool srgb,
                    const Footprint& footprint, bool& atBorder) const;
    glm::dvec3 bumped(const FlatTriangle& t, const glm::dvec3& normal, const glm::dvec3& weights,
                      const glm::dvec4& texel) const;

    const scene::Scene* scene_;
    scene::CameraFrame camera_;
    int width_, height_;
    std::vector<FlatTriangle> triangles_, last_;
    mutable std::map<const scene::TextureRef*, std::unique_ptr<TextureReference>> textures_;
};

}  // namespace penumbra::tests
