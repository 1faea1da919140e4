// SPDX-License-Identifier: MIT
// Twin of kernels/lib/texture.h and of what surfaces let through, in double, from the glTF 2.0
// specification (3.9: textures, alpha modes; KHR_texture_transform).
#pragma once
#include <array>
#include <glm/glm.hpp>

#include "host/scene/scene.h"

namespace penumbra::tests {

/// A point of a triangle of a primitive.
struct SurfacePoint {
    std::array<std::uint32_t, 3> vertices{};  ///< of the primitive
    glm::dvec3 barycentric{1, 0, 0};
};

/// Linear RGBA of an image at (u, v), largest level: nearest texel, or bilinear between texel
/// centres after decoding.
glm::dvec4 textureReference(const scene::Scene& scene, const scene::TextureRef& texture,
                            const glm::dvec2& uv, bool srgb);

/// Base colour and alpha: factor x texture x vertex colour.
glm::dvec4 baseColourReference(const scene::Scene& scene, const scene::Primitive& primitive,
                               const SurfacePoint& point);

/// Share of light that passes, per channel: OPAQUE 0 (its alpha is ignored); MASK 1 below its
/// cutoff, else 0; BLEND (1 - a)(1 - a + a c); transmission t: 1 - a + a t c.
glm::dvec3 transmittanceReference(const scene::Scene& scene, const scene::Primitive& primitive,
                                  const SurfacePoint& point);

}  // namespace penumbra::tests
