// SPDX-License-Identifier: MIT
#include "host/metrics/separable.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace penumbra::metrics {
namespace {

int radiusOf(const Taps& taps) {
    return static_cast<int>(taps.size() / 2);
}

/// target[i] += weight * source[i]; compilers turn it into vector instructions.
void addScaled(const float* source, float weight, int count, float* target) {
    for (int i = 0; i < count; ++i) target[i] += weight * source[i];
}

/// What the taps inside a line of `length` pixels are multiplied by, at each pixel.
std::vector<float> borderScales(const Taps& taps, int length) {
    const int radius = radiusOf(taps);
    std::vector<float> scales;
    for (int x = 0; x < length; ++x) {
        double all = 0, inside = 0;
        int at = x - radius;
        for (const double weight : taps) {
            all += weight;
            if (at >= 0 && at < length) inside += weight;
            ++at;
        }
        scales.push_back(static_cast<float>(all / inside));
    }
    return scales;
}

}  // namespace

std::vector<double> gaussianTaps(double sigma, int radius) {
    std::vector<double> taps;
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) {
        taps.push_back(std::exp(-x * x / (2 * sigma * sigma)));
        sum += taps.back();
    }
    for (double& tap : taps) tap /= sum;
    return taps;
}

void filterRows(const Plane& source, int width, const Taps& taps, Border border, Plane& target) {
    const int radius = radiusOf(taps);
    const auto stride = static_cast<std::size_t>(width);
    const auto scales = borderScales(taps, border == Border::renormalise ? width : 0);
    target.resize(source.size());
    Plane line(stride + 2 * static_cast<std::size_t>(radius), 0.0F);
    for (std::size_t row = 0; row < source.size(); row += stride) {
        const float* in = &source[row];
        std::copy(in, in + width, line.begin() + radius);
        if (border == Border::replicate) {
            std::fill_n(line.begin(), radius, in[0]);
            std::fill_n(line.end() - radius, radius, in[width - 1]);
        }
        float* out = &target[row];
        std::fill_n(out, width, 0.0F);
        for (std::size_t t = 0; t < taps.size(); ++t)
            addScaled(line.data() + t, taps[t], width, out);
        if (border == Border::renormalise)
            for (int x = 0; x < width; ++x) out[x] *= scales[static_cast<std::size_t>(x)];
    }
}

void filterColumns(const Plane& source, int width, const Taps& taps, Border border, Plane& target) {
    assert(&source != &target);
    const int radius = radiusOf(taps), height = static_cast<int>(source.size()) / width;
    const auto stride = static_cast<std::size_t>(width);
    const auto scales = borderScales(taps, border == Border::renormalise ? height : 0);
    target.assign(source.size(), 0.0F);
    for (int y = 0; y < height; ++y) {
        float* out = &target[static_cast<std::size_t>(y) * stride];
        int at = y - radius - 1;
        for (const float tap : taps) {
            ++at;
            if (border == Border::renormalise && (at < 0 || at >= height)) continue;
            const auto row = static_cast<std::size_t>(std::clamp(at, 0, height - 1));
            addScaled(&source[row * stride], tap, width, out);
        }
        if (border == Border::renormalise)
            for (int x = 0; x < width; ++x) out[x] *= scales[static_cast<std::size_t>(y)];
    }
}

void filterSeparable(const Plane& source, int width, const Taps& rows, const Taps& columns,
                     Border border, Plane& scratch, Plane& target) {
    filterRows(source, width, rows, border, scratch);
    filterColumns(scratch, width, columns, border, target);
}

}  // namespace penumbra::metrics
