// SPDX-License-Identifier: MIT
// Twin of the coverage rule in kernels/lib/raster.h, in exact integers and from the definition: a
// pixel belongs to a triangle if its centre lies inside, or on a top or a left edge.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace penumbra::tests {

/// Triangle in pixels; rows run downwards.
using PixelTriangle = std::array<glm::dvec2, 3>;

/// Snaps the vertices to 1/256 pixel (ties to even) and tells whether pixel (column, row) is
/// covered.
bool coversReference(const PixelTriangle& triangle, int column, int row);

}  // namespace penumbra::tests
