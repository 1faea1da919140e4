// SPDX-License-Identifier: MIT
#include "host/scene/poisson_disk.h"

#include <algorithm>
#include <cmath>

namespace penumbra::scene {
namespace {

constexpr int kCandidates = 30;   // per active point, as Bridson proposes
constexpr int kSearchSteps = 24;  // of the distance
constexpr double kPi = 3.14159265358979323846;

/// Points of the domain by cells that hold at most one: a cell's diagonal is the distance.
class Grid {
  public:
    Grid(double distance, bool disk)
        : distance_(distance),
          disk_(disk),
          cells_(static_cast<int>(std::ceil(2 / (distance / std::sqrt(2.0))))) {
        points_.assign(static_cast<std::size_t>(cells_) * static_cast<std::size_t>(cells_), -1);
    }
    bool fits(const glm::dvec2& p, const std::vector<glm::dvec2>& points) const {
        if (std::abs(p.x) > 1 || std::abs(p.y) > 1 || (disk_ && glm::dot(p, p) > 1)) return false;
        const int x = cellOf(p.x), y = cellOf(p.y);
        for (int row = std::max(y - 2, 0); row <= std::min(y + 2, cells_ - 1); ++row)
            for (int column = std::max(x - 2, 0); column <= std::min(x + 2, cells_ - 1); ++column) {
                const int other = points_[at(column, row)];
                if (other < 0) continue;
                const glm::dvec2 apart = points[static_cast<std::size_t>(other)] - p;
                if (glm::dot(apart, apart) < distance_ * distance_) return false;
            }
        return true;
    }
    void add(const glm::dvec2& p, int index) { points_[at(cellOf(p.x), cellOf(p.y))] = index; }

  private:
    int cellOf(double v) const {
        return std::clamp(static_cast<int>((v + 1) / 2 * cells_), 0, cells_ - 1);
    }
    std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(cells_) +
               static_cast<std::size_t>(column);
    }
    double distance_;
    bool disk_;
    int cells_;
    std::vector<int> points_;
};

/// Bridson's algorithm until the domain is full.
std::vector<glm::dvec2> fill(double distance, bool disk, std::uint32_t seed) {
    std::uint32_t state = seed * 2654435769U + 12345U;
    Grid grid(distance, disk);
    std::vector<glm::dvec2> points{
        {(2 * uniform(state) - 1) * 0.5, (2 * uniform(state) - 1) * 0.5}};
    std::vector<int> active{0};
    grid.add(points[0], 0);
    while (!active.empty()) {
        const auto pick = std::min(static_cast<std::size_t>(uniform(state) * active.size()),
                                   active.size() - 1);
        const glm::dvec2 from = points[static_cast<std::size_t>(active[pick])];
        bool found = false;
        for (int i = 0; i < kCandidates && !found; ++i) {
            // Evenly over the ring between one and two distances
            const double radius = distance * std::sqrt(1 + 3 * uniform(state));
            const double angle = 2 * kPi * uniform(state);
            const glm::dvec2 p = from + radius * glm::dvec2(std::cos(angle), std::sin(angle));
            if (!grid.fits(p, points)) continue;
            grid.add(p, static_cast<int>(points.size()));
            active.push_back(static_cast<int>(points.size()));
            points.push_back(p);
            found = true;
        }
        if (found) continue;
        active[pick] = active.back();
        active.pop_back();
    }
    return points;
}

}  // namespace

double uniform(std::uint32_t& state) {
    state = state * 747796405U + 2891336453U;
    std::uint32_t word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737U;
    word = (word >> 22) ^ word;
    return (word + 0.5) / 4294967296.0;
}

std::vector<glm::dvec2> poissonDisk(int count, bool disk, std::uint32_t seed) {
    if (count == 1) return {{0, 0}};
    // Disks of half the distance cover about 0.7 of the domain: a bracket for the search
    const double area = disk ? kPi : 4;
    const double middle = 2 * std::sqrt(0.7 * area / (kPi * count));
    double low = middle * 0.6, high = std::min(middle * 1.6, 1.9);
    std::vector<glm::dvec2> best;
    for (int step = 0; step < kSearchSteps; ++step) {
        const double distance = (low + high) / 2;
        auto points = fill(distance, disk, seed);
        const auto found = static_cast<int>(points.size());
        if (found >= count) {
            low = distance;
            if (best.empty() || points.size() <= best.size()) best = std::move(points);
            if (found == count) break;
        } else {
            high = distance;
        }
    }
    // Fewer than asked for at every distance tried: a smaller distance always gives more
    for (double distance = low; static_cast<int>(best.size()) < count; distance *= 0.9)
        best = fill(distance, disk, seed);
    best.resize(static_cast<std::size_t>(count));
    return best;
}

}  // namespace penumbra::scene
