// SPDX-License-Identifier: MIT
#include "tests/reference/ssim_ref.h"

#include <cmath>
#include <cstddef>

namespace penumbra::tests {
namespace {

struct Sample {
    double a, b, weight;
};

/// The pixels of the 11x11 window around (x, y) that exist; weights sum to 1.
std::vector<Sample> windowAt(const std::vector<double>& a, const std::vector<double>& b, int width,
                             int height, int x, int y) {
    std::vector<Sample> window;
    double total = 0;
    for (int v = y - 5; v <= y + 5; ++v)
        for (int u = x - 5; u <= x + 5; ++u) {
            if (u < 0 || v < 0 || u >= width || v >= height) continue;
            const double squared = (u - x) * (u - x) + (v - y) * (v - y);
            const auto i = static_cast<std::size_t>(v) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(u);
            window.push_back({a[i], b[i], std::exp(-squared / (2 * 1.5 * 1.5))});
            total += window.back().weight;
        }
    for (auto& sample : window) sample.weight /= total;
    return window;
}

}  // namespace

std::vector<double> ssimMap(const std::vector<double>& a, const std::vector<double>& b, int width,
                            int height) {
    const double c1 = 0.0001, c2 = 0.0009;
    std::vector<double> map;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto window = windowAt(a, b, width, height, x, y);
            double meanA = 0, meanB = 0, varianceA = 0, varianceB = 0, covariance = 0;
            for (const auto& s : window) {
                meanA += s.weight * s.a;
                meanB += s.weight * s.b;
            }
            for (const auto& s : window) {
                varianceA += s.weight * (s.a - meanA) * (s.a - meanA);
                varianceB += s.weight * (s.b - meanB) * (s.b - meanB);
                covariance += s.weight * (s.a - meanA) * (s.b - meanB);
            }
            map.push_back((2 * meanA * meanB + c1) * (2 * covariance + c2) /
                          ((meanA * meanA + meanB * meanB + c1) * (varianceA + varianceB + c2)));
        }
    return map;
}

}  // namespace penumbra::tests
