// SPDX-License-Identifier: MIT
// Twin of kernels/lib/texture.h in double, from glTF 2.0 (3.8) and KHR_texture_transform: texel
// centres at half integers, bilinear or nearest, each level of the MIP pyramid half of the last.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/scene.h"

namespace penumbra::tests {

class TextureReference {
  public:
    /// `srgb`: the colours are decoded before they are filtered; alpha never is.
    TextureReference(const scene::Image& image, const scene::TextureRef& use, bool srgb);

    /// Where uv lands in the image after the texture's transform; 1 is a whole image.
    glm::dvec2 transform(const glm::dvec2& uv) const;
    /// Value at uv (before the transform); `level` is clamped to those that exist.
    glm::dvec4 read(const glm::dvec2& uv, int level) const;
    /// log2 of the longer of the steps to the two neighbours, in texels of level 0.
    double level(const glm::dvec2& uv, const glm::dvec2& right, const glm::dvec2& below) const;
    /// True where a small error of uv reads another texel (nearest filter).
    bool atTexelBorder(const glm::dvec2& uv, int level) const;

  private:
    struct Level {
        int width, height;
        std::vector<glm::dvec4> encoded;  ///< as 8-bit values / 255
    };
    const Level& levelAt(int level) const;
    glm::dvec4 texel(const Level& level, double column, double row) const;
    scene::TextureRef use_;
    bool srgb_;
    std::vector<Level> levels_;
};

}  // namespace penumbra::tests
