// SPDX-License-Identifier: MIT
// Two pictures of noise for the benchmarks of metrics, which run on one core of the host.
#pragma once
#include <random>

#include "host/metrics/picture.h"

namespace penumbra::bench {

inline metrics::Picture noise(int width, int height, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<float> distribution(0, 1);
    metrics::Picture picture{width, height, metrics::Encoding::srgb, {}};
    for (int c = 0; c < 3; ++c) {
        auto& plane = picture.planes.emplace_back();
        for (int i = 0; i < width * height; ++i) plane.push_back(distribution(generator));
    }
    return picture;
}

}  // namespace penumbra::bench
