// SPDX-License-Identifier: MIT
#include "tests/reference/raster_ref.h"

namespace penumbra::tests {
namespace {

struct Point {
    std::int64_t x, y;
};

/// Twice the signed area; below 0 where c lies to the right of a -> b and b is below a.
std::int64_t orientation(Point a, Point b, Point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool insideEdge(Point a, Point b, Point third, Point p) {
    if (a.y > b.y) std::swap(a, b);  // b is below a, or beside it
    const auto inner = orientation(a, b, third), side = orientation(a, b, p);
    if (side != 0) return (side > 0) == (inner > 0);
    const bool top = a.y == b.y && third.y > a.y;
    const bool left = a.y != b.y && inner < 0;
    return top || left;
}

Point snap(const glm::dvec2& v) {
    return {std::llrint(v.x * 256), std::llrint(v.y * 256)};
}

}  // namespace

bool coversReference(const PixelTriangle& triangle, int column, int row) {
    const Point v[3] = {snap(triangle[0]), snap(triangle[1]), snap(triangle[2])};
    if (orientation(v[0], v[1], v[2]) == 0) return false;
    const Point centre{column * 256LL + 128, row * 256LL + 128};
    for (int i = 0; i < 3; ++i)
        if (!insideEdge(v[i], v[(i + 1) % 3], v[(i + 2) % 3], centre)) return false;
    return true;
}

}  // namespace penumbra::tests
