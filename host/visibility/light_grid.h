// SPDX-License-Identifier: MIT
// The light's samples as cells of a grid, for occlusion masks: a bit each, a row at a time.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/light.h"
#include "kernels/shared/raster4d.h"

namespace penumbra::visibility {

/// Cells of equal size over the light's sides, at most one sample in each. A cell's centre lies at
/// whole grid coordinates (column, row).
struct LightGrid {
    int columns = 1, rows = 1;
    bool centred = true;              ///< all samples lie at the centres of their cells
    std::vector<int> sample;          ///< [rows, columns] index into the light's samples, -1: none
    std::vector<glm::vec2> position;  ///< [rows, columns] grid coordinates of the sample
    double cellWidth = 1, cellHeight = 1;  ///< metres
    int words() const { return columns > 32 ? 2 : 1; }
    std::size_t cellAt(int row, int column) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
               static_cast<std::size_t>(column);
    }
};

/// The smallest grid of at most 64 x 64 cells that keeps the light's samples apart; one with all
/// samples at the centres of their cells where that takes no more than twice as many cells as there
/// are samples. So M x N samples get M x N cells, 2^k hammersley and jittered samples a cell each,
/// disks and Poisson samples some empty cells. Throws Error (usage) where there is none, naming
/// what works.
LightGrid fitLightGrid(const scene::AreaLight& light);

/// Grid coordinates from the re-based world (`centre`), and what hangs on the grid and the casters.
shared::Raster4dParams gridParams(const LightGrid& grid, const scene::AreaLight& light,
                                  const scene::Bounds& casters, const glm::dvec3& centre);

}  // namespace penumbra::visibility
