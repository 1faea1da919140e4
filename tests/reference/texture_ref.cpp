// SPDX-License-Identifier: MIT
#include "tests/reference/texture_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

double decode(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double encode(double linear) {
    return linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

glm::dvec4 linearOf(glm::dvec4 encoded, bool srgb) {
    for (int i = 0; srgb && i < 3; ++i) encoded[i] = decode(encoded[i]);
    return encoded;
}

/// Texel that coordinate i stands for, by the definitions of GL_REPEAT, GL_CLAMP_TO_EDGE and
/// GL_MIRRORED_REPEAT.
int wrapped(double i, int size, scene::Wrap wrap) {
    if (wrap == scene::Wrap::clamp) return static_cast<int>(std::clamp(i, 0.0, size - 1.0));
    const double period = std::floor(i / size);
    const int inside = static_cast<int>(i - period * size);
    const bool odd = std::fmod(std::abs(period), 2.0) == 1;
    return wrap == scene::Wrap::mirror && odd ? size - 1 - inside : inside;
}

}  // namespace

TextureReference::TextureReference(const scene::Image& image, const scene::TextureRef& use,
                                   bool srgb)
    : use_(use), srgb_(srgb) {
    Level first{image.width, image.height, {}};
    for (std::size_t i = 0; i + 3 < image.texels.size(); i += 4)
        first.encoded.push_back(glm::dvec4(image.texels[i], image.texels[i + 1],
                                           image.texels[i + 2], image.texels[i + 3]) /
                                255.0);
    levels_.push_back(first);
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        const Level& fine = levels_.back();
        Level coarse{std::max(fine.width / 2, 1), std::max(fine.height / 2, 1), {}};
        for (int y = 0; y < coarse.height; ++y)
            for (int x = 0; x < coarse.width; ++x) {
                glm::dvec4 sum(0);
                for (int i = 0; i < 4; ++i) {
                    const int fx = std::min(2 * x + i % 2, fine.width - 1);
                    const int fy = std::min(2 * y + i / 2, fine.height - 1);
                    sum += linearOf(fine.encoded[static_cast<std::size_t>(fy * fine.width + fx)],
                                    srgb);
                }
                glm::dvec4 mean = sum / 4.0;
                for (int i = 0; srgb && i < 3; ++i) mean[i] = encode(mean[i]);
                // Halves are rounded up, also those that come out a little smaller
                coarse.encoded.push_back(glm::floor(mean * 255.0 + (0.5 + 1e-9)) / 255.0);
            }
        levels_.push_back(coarse);
    }
}

glm::dvec2 TextureReference::transform(const glm::dvec2& uv) const {
    const glm::dmat3x2 m(use_.uvFromUv);
    return m * glm::dvec3(uv, 1);
}

const TextureReference::Level& TextureReference::levelAt(int level) const {
    return levels_[static_cast<std::size_t>(
        std::clamp(level, 0, static_cast<int>(levels_.size()) - 1))];
}

glm::dvec4 TextureReference::texel(const Level& level, double column, double row) const {
    const int x = wrapped(column, level.width, use_.wrapU);
    const int y = wrapped(row, level.height, use_.wrapV);
    return linearOf(level.encoded[static_cast<std::size_t>(y * level.width + x)], srgb_);
}

glm::dvec4 TextureReference::read(const glm::dvec2& uv, int level) const {
    const Level& image = levelAt(level);
    const glm::dvec2 at = transform(uv) * glm::dvec2(image.width, image.height);
    if (use_.nearest) return texel(image, std::floor(at.x), std::floor(at.y));
    // A texel weighs by the distance of its centre
    glm::dvec4 sum(0);
    const glm::dvec2 corner = glm::floor(at - 0.5);
    for (int i = 0; i < 4; ++i) {
        const glm::dvec2 cell = corner + glm::dvec2(i % 2, i / 2);
        const glm::dvec2 weight = 1.0 - glm::abs(at - (cell + 0.5));
        sum += weight.x * weight.y * texel(image, cell.x, cell.y);
    }
    return sum;
}

double TextureReference::level(const glm::dvec2& uv, const glm::dvec2& right,
                               const glm::dvec2& below) const {
    const glm::dvec2 size(levels_[0].width, levels_[0].height);
    const double across = glm::length((transform(right) - transform(uv)) * size);
    const double down = glm::length((transform(below) - transform(uv)) * size);
    return std::log2(std::max(across, down));
}

bool TextureReference::atTexelBorder(const glm::dvec2& uv, int level) const {
    if (!use_.nearest) return false;
    const Level& image = levelAt(level);
    const glm::dvec2 at = transform(uv) * glm::dvec2(image.width, image.height);
    const glm::dvec2 off = glm::abs(at - glm::round(at));
    return std::min(off.x, off.y) < 2e-3;
}

}  // namespace penumbra::tests
