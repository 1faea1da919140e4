// SPDX-License-Identifier: MIT
// Share of an area light that a point sees past simple occluders, in closed form or, where there is
// none, by one integral. All in double and on the light's plane, onto which occluders are projected
// from the point.
#pragma once
#include <glm/glm.hpp>
#include <vector>

namespace penumbra::tests {

/// Corners in order, either way round.
using Polygon = std::vector<glm::dvec2>;

double area(const Polygon& polygon);
/// What lies where normal . q > offset; the polygon is convex.
Polygon clipped(const Polygon& polygon, const glm::dvec2& normal, double offset);
/// Corners of the smallest convex polygon that holds the points, counter-clockwise.
Polygon convexHull(std::vector<glm::dvec2> points);
/// Area that two convex polygons share; the second's corners are counter-clockwise.
double commonArea(const Polygon& a, const Polygon& b);

/// Where the ray from `point` through `q` meets the horizontal plane at height `height`: (x, z).
glm::dvec2 projected(const glm::dvec3& point, const glm::dvec3& q, double height);

/// Share of a horizontal disk about (0, height, 0) that `point` sees past a sphere. The sphere's
/// cone cuts the disk's plane in an ellipse: chords of it are exact, and midpoints add them up (to
/// 4e-6 with the default). The sphere lies higher over the point than its radius.
double diskBesideSphere(const glm::dvec3& point, double diskRadius, double height,
                        const glm::dvec3& centre, double radius, int chords = 4000);

}  // namespace penumbra::tests
