// SPDX-License-Identifier: MIT
#include "tests/reference/irradiance_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

/// Irradiance below a corner of a rectangle of x by y, in units of the distance; odd in both.
double belowCorner(double x, double y) {
    const double a = std::sqrt(1 + x * x), b = std::sqrt(1 + y * y);
    return 0.5 * (x / a * std::atan(y / a) + y / b * std::atan(x / b));
}

}  // namespace

double irradianceReference(const scene::AreaLight& light, const glm::dvec3& point,
                           const glm::dvec3& normal, int steps) {
    double sum = 0;
    const double w = light.width / 2, h = light.height / 2;
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            const double a = (i + 0.5) / steps, b = (j + 0.5) / steps;
            // Rings of equal area on a disk
            const double r = std::sqrt(a), angle = 2 * M_PI * b;
            const double x = light.disk ? w * r * std::cos(angle) : w * (2 * a - 1);
            const double y = light.disk ? h * r * std::sin(angle) : h * (2 * b - 1);
            const glm::dvec3 offset = light.centre + x * light.axisX + y * light.axisY - point;
            const double squared = glm::dot(offset, offset);
            const double receiver = std::max(glm::dot(normal, offset), 0.0);
            const double emitter = std::max(-glm::dot(light.axisZ, offset), 0.0);
            sum += receiver * emitter / (squared * squared);
        }
    const double area = light.disk ? M_PI * w * h : 4 * w * h;
    return sum * area / (static_cast<double>(steps) * steps);
}

double parallelIrradiance(const scene::AreaLight& light, const glm::dvec2& offset,
                          double distance) {
    if (light.disk) {
        const double r = light.width / 2, squared = glm::dot(offset, offset) + distance * distance;
        const double sum = squared + r * r;
        return M_PI / 2 *
               (1 -
                (squared - r * r) / std::sqrt(sum * sum - 4 * r * r * glm::dot(offset, offset)));
    }
    const glm::dvec2 half(light.width / 2, light.height / 2);
    const glm::dvec2 low = (-half - offset) / distance, high = (half - offset) / distance;
    return belowCorner(high.x, high.y) - belowCorner(low.x, high.y) - belowCorner(high.x, low.y) +
           belowCorner(low.x, low.y);
}

double perpendicularIrradiance(double width, double height, double distance) {
    // Two corners, one to either side
    const double across = height / 2, far = std::hypot(distance, width);
    return std::atan(across / distance) - distance / far * std::atan(across / far);
}

}  // namespace penumbra::tests
