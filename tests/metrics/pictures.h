// SPDX-License-Identifier: MIT
// Pictures for the tests of SSIM and FLIP.
#pragma once
#include <random>

#include "host/metrics/picture.h"

namespace penumbra::tests {

inline metrics::Picture uniform(int width, int height, const std::vector<float>& colour,
                                metrics::Encoding encoding = metrics::Encoding::srgb) {
    metrics::Picture picture{width, height, encoding, {}};
    for (const float value : colour)
        picture.planes.emplace_back(static_cast<std::size_t>(width * height), value);
    return picture;
}

/// Independent values in [0, 1].
inline metrics::Picture noise(int width, int height, std::size_t planes, unsigned seed,
                              metrics::Encoding encoding = metrics::Encoding::srgb) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> distribution(0, 1);
    auto picture = uniform(width, height, std::vector<float>(planes, 0), encoding);
    for (auto& plane : picture.planes)
        for (float& value : plane) value = distribution(generator);
    return picture;
}

/// A soft-edged disk on a gradient: smooth parts, an edge, colours.
inline metrics::Picture still(int width, int height) {
    auto picture = uniform(width, height, {0, 0, 0});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto i = static_cast<std::size_t>(y * width + x);
            const float u = static_cast<float>(x) / static_cast<float>(width);
            const float v = static_cast<float>(y) / static_cast<float>(height);
            const bool inside = (u - 0.5F) * (u - 0.5F) + (v - 0.5F) * (v - 0.5F) < 0.09F;
            picture.planes[0][i] = inside ? 0.8F : 0.2F + 0.3F * u;
            picture.planes[1][i] = inside ? 0.3F : 0.4F;
            picture.planes[2][i] = 0.3F + 0.4F * v;
        }
    return picture;
}

/// The picture plus `amount` times noise in [-0.5, 0.5], the same in all planes.
inline metrics::Picture withNoise(metrics::Picture picture, float amount, unsigned seed = 1) {
    const auto added = noise(picture.width, picture.height, 1, seed);
    for (auto& plane : picture.planes)
        for (std::size_t i = 0; i < plane.size(); ++i)
            plane[i] += amount * (added.planes[0][i] - 0.5F);
    return picture;
}

}  // namespace penumbra::tests
