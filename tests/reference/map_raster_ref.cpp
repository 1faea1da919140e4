// SPDX-License-Identifier: MIT
#include "tests/reference/map_raster_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

/// Distance of p from the segment a b.
double segmentDistance(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 along = b - a;
    const double squared = glm::dot(along, along);
    const double t = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0, 1.0) : 0;
    return glm::length(p - a - t * along);
}

}  // namespace

std::vector<MapTexel> castMap(const scene::AreaLight& light, const glm::dvec2& sample,
                              const std::vector<glm::dvec3>& corners, double focal, double near,
                              int size) {
    const glm::dvec3 eye = light.centre + sample.x * light.axisX + sample.y * light.axisY;
    std::vector<MapTexel> map(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            MapTexel& texel = map[static_cast<std::size_t>(row) * static_cast<std::size_t>(size) +
                                  static_cast<std::size_t>(column)];
            const glm::dvec2 pixel(column + 0.5, row + 0.5);
            const glm::dvec3 direction = light.axisZ +
                                         (pixel.x - 0.5 * size) / focal * light.axisX +
                                         (pixel.y - 0.5 * size) / focal * light.axisY;
            for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
                const glm::dvec3 &a = corners[t], &b = corners[t + 1], &c = corners[t + 2];
                glm::dvec2 flat[3];
                for (int i = 0; i < 3; ++i) {
                    const glm::dvec3 p = corners[t + static_cast<std::size_t>(i)] - eye;
                    const double z = glm::dot(p, light.axisZ);
                    flat[i] = focal / z * glm::dvec2(glm::dot(p, light.axisX),
                                                     glm::dot(p, light.axisY)) +
                              0.5 * size;
                }
                for (int i = 0; i < 3; ++i)
                    texel.margin = std::min(
                        texel.margin, segmentDistance(pixel, flat[i], flat[(i + 1) % 3]));
                // The ray meets the plane inside of all three edges
                const glm::dvec3 normal = glm::cross(b - a, c - a);
                const double facing = glm::dot(normal, direction);
                if (std::abs(facing) < 1e-12) continue;
                const double z = glm::dot(normal, a - eye) / facing;
                const glm::dvec3 hit = eye + z * direction;
                const double u = glm::dot(glm::cross(b - a, hit - a), normal);
                const double v = glm::dot(glm::cross(c - b, hit - b), normal);
                const double w = glm::dot(glm::cross(a - c, hit - c), normal);
                if (z <= 0 || u < 0 || v < 0 || w < 0) continue;
                texel.depth = std::max(texel.depth, std::min(near / z, 1.0));
            }
        }
    return map;
}

}  // namespace penumbra::tests
