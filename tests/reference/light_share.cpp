// SPDX-License-Identifier: MIT
#include "tests/reference/light_share.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

/// Appends the lower chain of points in order of x.
void appendChain(const std::vector<glm::dvec2>& sorted, Polygon& hull) {
    const std::size_t first = hull.size();
    for (const auto& p : sorted) {
        while (hull.size() >= first + 2 &&
               cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
            hull.pop_back();
        hull.push_back(p);
    }
    hull.pop_back();  // begins the other chain
}

}  // namespace

double area(const Polygon& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i)
        twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return std::abs(twice) / 2;
}

Polygon clipped(const Polygon& polygon, const glm::dvec2& normal, double offset) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const auto a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        const double da = glm::dot(normal, a) - offset, db = glm::dot(normal, b) - offset;
        if (da > 0) kept.push_back(a);
        if ((da > 0) != (db > 0)) kept.push_back(glm::mix(a, b, da / (da - db)));
    }
    return kept;
}

Polygon convexHull(std::vector<glm::dvec2> points) {
    std::sort(points.begin(), points.end(), [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    });
    Polygon hull;
    appendChain(points, hull);
    std::reverse(points.begin(), points.end());
    appendChain(points, hull);
    return hull;
}

double commonArea(const Polygon& a, const Polygon& b) {
    Polygon common = a;
    for (std::size_t i = 0; i < b.size(); ++i) {
        const glm::dvec2 along = b[(i + 1) % b.size()] - b[i], inwards(-along.y, along.x);
        common = clipped(common, inwards, glm::dot(inwards, b[i]));
    }
    return area(common);
}

glm::dvec2 projected(const glm::dvec3& point, const glm::dvec3& q, double height) {
    const glm::dvec3 hit = point + (q - point) * ((height - point.y) / (q.y - point.y));
    return {hit.x, hit.z};
}

double diskBesideSphere(const glm::dvec3& point, double diskRadius, double height,
                        const glm::dvec3& centre, double radius, int chords) {
    const glm::dvec3 c = centre - point;
    const double h = height - point.y, power = glm::dot(c, c) - radius * radius;
    double hidden = 0;
    for (int i = 0; i < chords; ++i) {
        // z = R sin(angle): chords lie closer where they shorten fast
        const double angle = M_PI * ((i + 0.5) / chords - 0.5);
        const double z = diskRadius * std::sin(angle), half = diskRadius * std::cos(angle);
        const double dz = z - point.z;
        // Hidden where (c . d)^2 > power d . d, for d = (u, h, dz): a u^2 + 2 b u + k > 0
        const double along = c.y * h + c.z * dz;
        const double a = c.x * c.x - power, b = c.x * along;
        const double k = along * along - power * (h * h + dz * dz);
        const double discriminant = b * b - a * k;
        if (discriminant <= 0) continue;
        const double middle = point.x - b / a, reach = std::sqrt(discriminant) / -a;
        const double chord = std::min(middle + reach, half) - std::max(middle - reach, -half);
        hidden += std::max(chord, 0.0) * half * M_PI / chords;
    }
    return 1 - hidden / (M_PI * diskRadius * diskRadius);
}

}  // namespace penumbra::tests
