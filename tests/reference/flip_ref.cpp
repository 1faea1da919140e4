// SPDX-License-Identifier: MIT
#include "tests/reference/flip_ref.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <glm/glm.hpp>

namespace penumbra::tests {
namespace {

const double kPi = std::acos(-1.0);

/// XYZ from linear RGB, from what BT.709 says of its primaries and of white.
glm::dmat3 xyzFromRgb() {
    const auto xyz = [](double x, double y) { return glm::dvec3(x / y, 1, (1 - x - y) / y); };
    const glm::dmat3 primaries(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
    const glm::dvec3 amounts = glm::inverse(primaries) * xyz(0.3127, 0.3290);
    return {primaries[0] * amounts[0], primaries[1] * amounts[1], primaries[2] * amounts[2]};
}

glm::dvec3 white() {
    return xyzFromRgb() * glm::dvec3(1);
}

glm::dvec3 yCxCzFromSrgb(const Rgb& srgb) {
    glm::dvec3 linear;
    for (int c = 0; c < 3; ++c) {
        const double v = srgb[static_cast<std::size_t>(c)];
        linear[c] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    const glm::dvec3 r = xyzFromRgb() * linear / white();
    return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
}

/// Back to linear RGB, into the cube, to L*a*b* with the Hunt adjustment.
glm::dvec3 huntLabFromYCxCz(const glm::dvec3& yCxCz) {
    const double y = (yCxCz.x + 16) / 116;
    const glm::dvec3 r(y + yCxCz.y / 500, y, y - yCxCz.z / 200);
    const glm::dvec3 rgb =
        glm::clamp(glm::inverse(xyzFromRgb()) * (r * white()), glm::dvec3(0), glm::dvec3(1));
    const glm::dvec3 t = xyzFromRgb() * rgb / white();
    glm::dvec3 f;
    for (int c = 0; c < 3; ++c)
        f[c] = t[c] > 216.0 / 24389 ? std::cbrt(t[c]) : (24389.0 / 27 * t[c] + 16) / 116;
    const double lightness = 116 * f.y - 16;
    return {lightness, 0.01 * lightness * 500 * (f.x - f.y), 0.01 * lightness * 200 * (f.y - f.z)};
}

double hyab(const glm::dvec3& p, const glm::dvec3& q) {
    return std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z);
}

/// A square kernel of 2 * radius + 1 pixels a side, row by row, from a function of (x, y) in
/// pixels.
struct Kernel {
    int radius;
    std::vector<double> weights;
    Kernel(int r, const std::function<double(double, double)>& weight) : radius(r) {
        for (int y = -r; y <= r; ++y)
            for (int x = -r; x <= r; ++x) weights.push_back(weight(x, y));
    }
    /// Positive weights sum to 1, negative ones to -1.
    Kernel& normalise() {
        double positive = 0, negative = 0;
        for (const double w : weights) (w > 0 ? positive : negative) += std::abs(w);
        for (double& w : weights)
            if (w != 0) w /= w > 0 ? positive : negative;
        return *this;
    }
};

struct Grid {
    int width, height;
    std::vector<glm::dvec3> values;
    const glm::dvec3& at(int x, int y) const {
        x = std::clamp(x, 0, width - 1);
        y = std::clamp(y, 0, height - 1);
        return values[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
    double filtered(const Kernel& kernel, int channel, int x, int y) const {
        double sum = 0;
        std::size_t i = 0;
        for (int v = -kernel.radius; v <= kernel.radius; ++v)
            for (int u = -kernel.radius; u <= kernel.radius; ++u)
                sum += kernel.weights[i++] * at(x + u, y + v)[channel];
        return sum;
    }
};

Kernel sensitivity(double a1, double b1, double a2, double b2, double ppd) {
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * ppd));
    return Kernel(radius,
                  [=](double x, double y) {
                      const double squared = (x * x + y * y) / (ppd * ppd);  // degrees^2
                      return a1 * std::sqrt(kPi / b1) * std::exp(-kPi * kPi * squared / b1) +
                             a2 * std::sqrt(kPi / b2) * std::exp(-kPi * kPi * squared / b2);
                  })
        .normalise();
}

/// Derivatives of a Gaussian along x (or y): the first finds edges, the second points.
Kernel feature(bool points, bool alongY, double ppd) {
    const double sigma = 0.5 * 0.082 * ppd;
    return Kernel(static_cast<int>(std::ceil(3 * sigma)),
                  [=](double x, double y) {
                      const double t = alongY ? y : x;
                      const double g = std::exp(-(x * x + y * y) / (2 * sigma * sigma));
                      return points ? (t * t / (sigma * sigma) - 1) * g : -t * g;
                  })
        .normalise();
}

}  // namespace

std::vector<double> flipMap(const std::vector<Rgb>& reference, const std::vector<Rgb>& test,
                            int width, int height, double pixelsPerDegree) {
    const double ppd = pixelsPerDegree;
    Grid grids[2] = {{width, height, {}}, {width, height, {}}};
    for (const auto& rgb : reference) grids[0].values.push_back(yCxCzFromSrgb(rgb));
    for (const auto& rgb : test) grids[1].values.push_back(yCxCzFromSrgb(rgb));
    const Kernel colour[] = {sensitivity(1, 0.0047, 0, 1e-5, ppd),
                             sensitivity(1, 0.0053, 0, 1e-5, ppd),
                             sensitivity(34.1, 0.04, 13.5, 0.025, ppd)};
    const Kernel features[2][2] = {{feature(false, false, ppd), feature(false, true, ppd)},
                                   {feature(true, false, ppd), feature(true, true, ppd)}};
    const double largest = std::pow(hyab(huntLabFromYCxCz(yCxCzFromSrgb({0, 1, 0})),
                                         huntLabFromYCxCz(yCxCzFromSrgb({0, 0, 1}))),
                                    0.7);
    std::vector<double> map;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            glm::dvec3 lab[2];
            double strengths[2][2];  // [picture][edges, points]
            for (int p = 0; p < 2; ++p) {
                glm::dvec3 seen;
                for (int c = 0; c < 3; ++c) seen[c] = grids[p].filtered(colour[c], c, x, y);
                lab[p] = huntLabFromYCxCz(seen);
                for (int k = 0; k < 2; ++k)  // Y + 16 over 116: 0 to 1; the offset drops out
                    strengths[p][k] = std::hypot(grids[p].filtered(features[k][0], 0, x, y),
                                                 grids[p].filtered(features[k][1], 0, x, y)) /
                                      116;
            }
            double difference = std::pow(hyab(lab[0], lab[1]), 0.7);
            difference = difference < 0.4 * largest
                             ? 0.95 * difference / (0.4 * largest)
                             : 0.95 + 0.05 * (difference - 0.4 * largest) / (0.6 * largest);
            const double edges = std::abs(strengths[0][0] - strengths[1][0]);
            const double points = std::abs(strengths[0][1] - strengths[1][1]);
            map.push_back(
                std::pow(difference, 1 - std::sqrt(std::max(edges, points) / std::sqrt(2.0))));
        }
    return map;
}

}  // namespace penumbra::tests
