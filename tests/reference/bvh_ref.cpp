// SPDX-License-Identifier: MIT
#include "tests/reference/bvh_ref.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace penumbra::tests {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Box {
    glm::dvec3 low{kInfinity}, high{-kInfinity};
    bool empty() const { return !(low.x <= high.x); }
    void add(double value, int axis) {
        if (std::isnan(value)) return;
        low[axis] = std::min(low[axis], value);
        high[axis] = std::max(high[axis], value);
    }
};

class Checker {
  public:
    Checker(const TreeCopy& tree, const TreeMesh& mesh)
        : tree_(tree), p_(tree.params), mesh_(mesh) {}

    std::vector<std::string> run() {
        checkLevels();
        if (faults_.empty()) checkMembership();
        if (faults_.empty()) {
            checkLeaves();
            checkLevelsAbove();
            checkOrder();
        }
        return faults_;
    }

  private:
    template <typename... Args>
    void require(bool holds, fmt::format_string<Args...> text, Args&&... args) {
        if (!holds && faults_.size() < 20)
            faults_.push_back(fmt::format(text, std::forward<Args>(args)...));
    }
    std::size_t slots(int level) const {
        return static_cast<std::size_t>(p_.nodeCount[level]) * BVH_WIDTH;
    }

    void checkLevels() {
        const auto casters = std::count(mesh_.casts.begin(), mesh_.casts.end(), true);
        require(p_.casterCount == casters, "{} casters, {} in the mesh", p_.casterCount, casters);
        const double leaves = std::ceil(static_cast<double>(casters) / BVH_LEAF);
        require(p_.leafCount == leaves, "{} leaves instead of {}", p_.leafCount, leaves);
        double below = leaves;
        int first = 0;
        for (int level = 0; level < p_.levels; ++level) {
            require(p_.nodeCount[level] == std::ceil(below / BVH_WIDTH), "level {} has {} nodes",
                    level, p_.nodeCount[level]);
            require(p_.firstNode[level] == first, "level {} begins at {}", level,
                    p_.firstNode[level]);
            below = p_.nodeCount[level];
            first += p_.nodeCount[level];
        }
        require(p_.levels ? below == 1 : casters == 0, "the tree has {} roots", below);
    }

    void checkMembership() {
        std::vector<int> uses(mesh_.triangles(), 0);
        for (std::size_t i = 0; i < static_cast<std::size_t>(p_.leafCount) * BVH_LEAF; ++i) {
            const auto triangle = tree_.leafTriangles[i];
            if (triangle == BVH_NO_TRIANGLE) continue;
            require(triangle < mesh_.triangles(), "slot {} holds triangle {}", i, triangle);
            if (triangle >= mesh_.triangles()) return;
            ++uses[triangle];
            order_.push_back(triangle);
            for (std::size_t k = 0; k < 9; ++k) {
                const float is =
                    tree_.leaves[i / BVH_LEAF * 9 * BVH_LEAF + k * BVH_LEAF + i % BVH_LEAF];
                const float is3 = mesh_.corners[3 * triangle + k / 3][static_cast<int>(k % 3)];
                require(
                    std::memcmp(&is, &is3, sizeof is) == 0 || (std::isnan(is) && std::isnan(is3)),
                    "corner {} of triangle {} is {} instead of {}", k, triangle, is, is3);
            }
        }
        for (std::size_t t = 0; t < uses.size(); ++t)
            require(uses[t] == (mesh_.casts[t] ? 1 : 0), "triangle {} is in {} leaves", t, uses[t]);
    }

    Box boxAt(int level, std::size_t slot) const {
        const auto node = static_cast<std::size_t>(p_.firstNode[level]) + slot / BVH_WIDTH;
        const float* values = &tree_.nodes[node * 6 * BVH_WIDTH + slot % BVH_WIDTH];
        Box box;
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = values[axis * BVH_WIDTH];
            box.high[axis] = values[(3 + axis) * BVH_WIDTH];
        }
        return box;
    }

    Box boundsOfLeaf(std::size_t leaf) const {
        Box bounds;
        for (std::size_t i = 0; i < BVH_LEAF && leaf < static_cast<std::size_t>(p_.leafCount);
             ++i) {
            const auto triangle = tree_.leafTriangles[leaf * BVH_LEAF + i];
            if (triangle == BVH_NO_TRIANGLE) continue;
            for (std::size_t c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis)
                    bounds.add(mesh_.corners[3 * triangle + c][axis], axis);
        }
        return bounds;
    }

    void checkLeaves() {
        for (std::size_t slot = 0; p_.levels > 0 && slot < slots(0); ++slot) {
            const Box box = boxAt(0, slot), bounds = boundsOfLeaf(slot);
            require(box.empty() == bounds.empty(), "box {} of the leaves is {}", slot,
                    box.empty() ? "empty" : "not empty");
            if (box.empty() || bounds.empty()) continue;
            for (int axis = 0; axis < 3; ++axis) {
                // Margin, and the rounding of float where it is added
                const double spare = p_.margin + 1.2e-7 * std::abs(bounds.low[axis]) +
                                     1.2e-7 * std::abs(bounds.high[axis]);
                const double below = bounds.low[axis] - box.low[axis];
                const double above = box.high[axis] - bounds.high[axis];
                require(!(below < 0) && !(above < 0), "leaf {} sticks out on axis {}", slot, axis);
                require(!(below > spare) && !(above > spare), "leaf {} is {} too large on axis {}",
                        slot, std::max(below, above), axis);
            }
        }
    }

    void checkLevelsAbove() {
        for (int level = 1; level < p_.levels; ++level)
            for (std::size_t slot = 0; slot < slots(level); ++slot) {
                Box joined;
                if (slot < static_cast<std::size_t>(p_.nodeCount[level - 1]))
                    for (std::size_t child = 0; child < BVH_WIDTH; ++child) {
                        const Box box = boxAt(level - 1, slot * BVH_WIDTH + child);
                        if (box.empty()) continue;
                        joined.low = glm::min(joined.low, box.low);
                        joined.high = glm::max(joined.high, box.high);
                    }
                const Box box = boxAt(level, slot);
                require(box.low == joined.low && box.high == joined.high,
                        "box {} of level {} is not the union of those below", slot, level);
            }
    }

    /// Bits of the cells interleaved, x lowest; `shift` moves the centroid by that many cells.
    std::uint64_t morton(std::uint32_t triangle, double shift) const {
        glm::dvec3 centroid(0);
        for (std::size_t c = 0; c < 3; ++c)
            centroid += glm::dvec3(mesh_.corners[3 * triangle + c]) / 3.0;
        const glm::dvec3 low(p_.low.x, p_.low.y, p_.low.z);
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double cell = (centroid[axis] - low[axis]) * p_.low.w + shift;
            if (!std::isfinite(cell)) return std::numeric_limits<std::uint64_t>::max();
            const auto whole =
                static_cast<std::uint64_t>(std::clamp(std::floor(cell), 0.0, 1023.0));
            for (int bit = 0; bit < 10; ++bit) key |= (whole >> bit & 1) << (3 * bit + axis);
        }
        return key;
    }

    /// Keys grow with each coordinate, so that float's cell lies between those a little lower and
    /// a little higher: no key may lie below what an earlier one is at least.
    void checkOrder() {
        constexpr double kRounding = 2e-3;  // cells: coordinates of 1000 cells in float
        std::uint64_t least = 0;
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const auto low = morton(order_[i], -kRounding), high = morton(order_[i], kRounding);
            require(high >= least, "triangle {} comes too late", order_[i]);
            if (i > 0 && low == high && morton(order_[i - 1], -kRounding) == low &&
                morton(order_[i - 1], kRounding) == low)
                require(order_[i - 1] < order_[i], "triangles {} and {} of one cell are swapped",
                        order_[i - 1], order_[i]);
            least = std::max(least, low);
        }
    }

    const TreeCopy& tree_;
    const shared::BvhParams& p_;
    const TreeMesh& mesh_;
    std::vector<std::uint32_t> order_;
    std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> treeFaults(const TreeCopy& tree, const TreeMesh& mesh) {
    return Checker(tree, mesh).run();
}

}  // namespace penumbra::tests
