// SPDX-License-Identifier: MIT
#include "tests/reference/surface_ref.h"

#include <cmath>

namespace penumbra::tests {
namespace {

/// Index of the texel that coordinate i of an endless row shows.
int wrapped(int i, int size, scene::Wrap wrap) {
    if (wrap == scene::Wrap::clamp) return std::min(std::max(i, 0), size - 1);
    const int period = wrap == scene::Wrap::mirror ? 2 * size : size;
    const int within = ((i % period) + period) % period;
    return within < size ? within : period - 1 - within;
}

double decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

glm::dvec4 texel(const scene::Image& image, const scene::TextureRef& t, int x, int y, bool srgb) {
    const int column = wrapped(x, image.width, t.wrapU), row = wrapped(y, image.height, t.wrapV);
    glm::dvec4 value;
    for (int c = 0; c < 4; ++c) {
        value[c] =
            image.texels[static_cast<std::size_t>(4 * (row * image.width + column) + c)] / 255.0;
        if (srgb && c < 3) value[c] = decode(value[c]);
    }
    return value;
}

template <typename Vector>
glm::dvec4 interpolate(const std::vector<Vector>& values, const SurfacePoint& point) {
    glm::dvec4 sum(0);
    for (int i = 0; i < 3; ++i)
        for (int c = 0; c < Vector::length(); ++c)
            sum[c] += point.barycentric[i] *
                      static_cast<double>(values[point.vertices[static_cast<std::size_t>(i)]][c]);
    return sum;
}

}  // namespace

glm::dvec4 textureReference(const scene::Scene& scene, const scene::TextureRef& t,
                            const glm::dvec2& uv, bool srgb) {
    const auto& image = scene.images[static_cast<std::size_t>(t.image)];
    const glm::dvec2 moved = glm::dmat3x2(t.uvFromUv) * glm::dvec3(uv, 1);
    const double u = moved.x * image.width, v = moved.y * image.height;
    if (t.nearest)
        return texel(image, t, static_cast<int>(std::floor(u)), static_cast<int>(std::floor(v)),
                     srgb);
    glm::dvec4 sum(0);
    const int x = static_cast<int>(std::floor(u - 0.5)), y = static_cast<int>(std::floor(v - 0.5));
    for (int j = y; j < y + 2; ++j)
        for (int i = x; i < x + 2; ++i)
            sum += (1 - std::abs(i + 0.5 - u)) * (1 - std::abs(j + 0.5 - v)) *
                   texel(image, t, i, j, srgb);
    return sum;
}

glm::dvec4 baseColourReference(const scene::Scene& scene, const scene::Primitive& p,
                               const SurfacePoint& point) {
    const auto& material = scene.materials[static_cast<std::size_t>(p.material)];
    glm::dvec4 colour(material.baseColor);
    const auto& texture = material.baseColorTexture;
    if (texture.image >= 0) {
        const auto& uvs = p.uvs[static_cast<std::size_t>(texture.uvSet)];
        const auto uv = uvs.empty() ? glm::dvec4(0) : interpolate(uvs, point);
        colour *= textureReference(scene, texture, {uv.x, uv.y}, true);
    }
    if (!p.colors.empty()) colour *= interpolate(p.colors, point);
    return colour;
}

glm::dvec3 transmittanceReference(const scene::Scene& scene, const scene::Primitive& p,
                                  const SurfacePoint& point) {
    const auto& material = scene.materials[static_cast<std::size_t>(p.material)];
    const glm::dvec4 base = baseColourReference(scene, p, point);
    const glm::dvec3 c(base);
    if (material.alphaMode == scene::AlphaMode::mask)
        return glm::dvec3(base.w < static_cast<double>(material.alphaCutoff) ? 1 : 0);
    const double a = material.alphaMode == scene::AlphaMode::opaque ? 1 : base.w;
    const double t = static_cast<double>(material.transmission);
    if (t > 0) return 1 - a + a * t * c;
    return (1 - a) * (1 - a + a * c);
}

}  // namespace penumbra::tests
