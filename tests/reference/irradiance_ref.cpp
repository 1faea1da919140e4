// SPDX-License-Identifier: MIT
#include "tests/reference/irradiance_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {

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

}  // namespace penumbra::tests
