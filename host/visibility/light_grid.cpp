// SPDX-License-Identifier: MIT
#include "host/visibility/light_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "runtime/error.h"

namespace penumbra::visibility {
namespace {

struct Size {
    int columns, rows;
    int cells() const { return columns * rows; }
};

/// All sizes with room for `count`, small ones first and square ones first among these.
std::vector<Size> sizesFor(int count) {
    std::vector<Size> sizes;
    for (int rows = 1; rows <= R4_ROWS; ++rows)
        for (int columns = 1; columns <= R4_ROWS; ++columns)
            if (columns * rows >= count) sizes.push_back({columns, rows});
    std::sort(sizes.begin(), sizes.end(), [](const Size& a, const Size& b) {
        if (a.cells() != b.cells()) return a.cells() < b.cells();
        return std::abs(a.columns - a.rows) < std::abs(b.columns - b.rows);
    });
    return sizes;
}

/// Sample in units of cells from the light's lowest corner.
glm::dvec2 inCells(const scene::AreaLight& light, const glm::dvec2& sample, const Size& size) {
    const auto along = [](double at, double side, int cells) {
        return side > 0 ? (at / side + 0.5) * cells : 0.5 * cells;
    };
    return {along(sample.x, light.width, size.columns), along(sample.y, light.height, size.rows)};
}

bool keepsApart(const scene::AreaLight& light, const Size& size, bool centred) {
    std::array<std::uint64_t, R4_ROWS> taken{};
    for (const auto& sample : light.samples) {
        const glm::dvec2 at = inCells(light, sample, size);
        const int column = std::clamp(static_cast<int>(at.x), 0, size.columns - 1);
        const int row = std::clamp(static_cast<int>(at.y), 0, size.rows - 1);
        if (centred && (std::abs(at.x - column - 0.5) > 1e-6 || std::abs(at.y - row - 0.5) > 1e-6))
            return false;
        const std::uint64_t bit = std::uint64_t{1} << column;
        if (taken[static_cast<std::size_t>(row)] & bit) return false;
        taken[static_cast<std::size_t>(row)] |= bit;
    }
    return true;
}

LightGrid gridOf(const scene::AreaLight& light, const Size& size, bool centred) {
    LightGrid grid;
    grid.columns = size.columns;
    grid.rows = size.rows;
    grid.centred = centred;
    const auto cells = static_cast<std::size_t>(size.cells());
    grid.sample.assign(cells, -1);
    grid.position.resize(cells);
    for (int row = 0; row < size.rows; ++row)
        for (int column = 0; column < size.columns; ++column)
            grid.position[grid.cellAt(row, column)] = {static_cast<float>(column),
                                                       static_cast<float>(row)};
    for (std::size_t i = 0; i < light.samples.size(); ++i) {
        const glm::dvec2 at = inCells(light, light.samples[i], size);
        const int column = std::clamp(static_cast<int>(at.x), 0, size.columns - 1);
        const int row = std::clamp(static_cast<int>(at.y), 0, size.rows - 1);
        const std::size_t cell = grid.cellAt(row, column);
        grid.sample[cell] = static_cast<int>(i);
        if (!centred)
            grid.position[cell] = {static_cast<float>(at.x - 0.5), static_cast<float>(at.y - 0.5)};
    }
    // A side of no length has cells as large as the other's, a point any
    const double longest = std::max(light.width, light.height);
    const double fallback = longest > 0 ? longest / std::max(size.columns, size.rows) : 1;
    grid.cellWidth = light.width > 0 ? light.width / size.columns : fallback;
    grid.cellHeight = light.height > 0 ? light.height / size.rows : fallback;
    return grid;
}

shared::float4 narrow(const glm::dvec3& v, double w) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
            static_cast<float>(w)};
}

/// What a float leaves over.
shared::float4 remainder(const glm::dvec3& v, double w) {
    const shared::float4 high = narrow(v, w);
    return narrow({v.x - double{high.x}, v.y - double{high.y}, v.z - double{high.z}},
                  w - double{high.w});
}

}  // namespace

LightGrid fitLightGrid(const scene::AreaLight& light) {
    const auto count = static_cast<int>(light.samples.size());
    const auto sizes = sizesFor(count);
    for (const auto& size : sizes)
        if (size.cells() <= 2 * count && keepsApart(light, size, true))
            return gridOf(light, size, true);
    for (const auto& size : sizes)
        if (keepsApart(light, size, false)) return gridOf(light, size, false);
    throw Error(fmt::format("raster4d: no grid of at most {} x {} cells keeps the {} samples of "
                            "light '{}' apart; allowed: --light-samples MxN of at most {}x{}, or "
                            "fewer samples",
                            R4_ROWS, R4_ROWS, count, light.name, R4_ROWS, R4_ROWS),
                ExitCode::usage);
}

shared::Raster4dParams gridParams(const LightGrid& grid, const scene::AreaLight& light,
                                  const scene::Bounds& casters, const glm::dvec3& centre) {
    shared::Raster4dParams p{};
    const glm::dvec3 origin = light.centre - centre;
    const double unit = std::max(grid.cellWidth, grid.cellHeight);
    const glm::dvec3 axes[] = {light.axisX / grid.cellWidth, light.axisY / grid.cellHeight,
                               light.axisZ / unit};
    const double shift[] = {(grid.columns - 1) / 2.0, (grid.rows - 1) / 2.0, 0};
    const glm::dvec3 frame[] = {light.axisX, light.axisY, light.axisZ};
    for (int i = 0; i < 3; ++i) {
        const double w = shift[i] - glm::dot(axes[i], origin);
        p.gridHigh.row[i] = narrow(axes[i], w);
        p.gridLow.row[i] = remainder(axes[i], w);
        p.lightFromWorld.row[i] = narrow(frame[i], -glm::dot(frame[i], origin));
    }
    const glm::dvec3 stepX = grid.cellWidth * light.axisX, stepY = grid.cellHeight * light.axisY;
    p.corner = narrow(origin - shift[0] * stepX - shift[1] * stepY, 0);
    p.cornerLow = remainder(origin - shift[0] * stepX - shift[1] * stepY, 0);
    p.stepX = narrow(stepX, 0);
    p.stepY = narrow(stepY, 0);
    p.halfWidth = static_cast<float>(light.width / 2);
    p.halfHeight = static_cast<float>(light.height / 2);
    p.columns = grid.columns;
    p.rows = grid.rows;
    p.words = grid.words();
    p.centred = grid.centred ? 1 : 0;
    p.slack = grid.centred ? 0 : 0.5F;
    p.samples = static_cast<int>(light.samples.size());
    const double radius = casters.empty ? unit : std::max(casters.radius(), 1e-30);
    const glm::dvec3 middle = casters.empty ? glm::dvec3(0) : casters.centre() - centre - origin;
    const double depth = std::max(glm::dot(light.axisZ, middle), radius / 2);
    const glm::dvec3 slope(glm::dot(axes[0], middle) / (depth / unit),
                           glm::dot(axes[1], middle) / (depth / unit), depth / unit);
    p.keyCentre = narrow(slope, 0);
    p.keyScale = narrow({depth * grid.cellWidth / (radius * unit),
                         depth * grid.cellHeight / (radius * unit), unit / radius},
                        0);
    return p;
}

}  // namespace penumbra::visibility
