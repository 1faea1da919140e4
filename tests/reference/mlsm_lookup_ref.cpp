// SPDX-License-Identifier: MIT
#include "tests/reference/mlsm_lookup_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

constexpr double kCluster = 0.5, kBehind = 0.5;  // of kernels/visibility/mlsm_lookup.cl

/// What comes through, fragment by fragment.
class Light {
  public:
    explicit Light(bool multiply) : multiply_(multiply) {}
    void take(const MlsmFragment& f, double hat) {
        if (multiply_) {
            for (std::size_t c = 0; c < 3; ++c) layer_[c] *= std::max(1 - f.taken[c] * hat, 0.0);
            return;
        }
        double left = f.coverage * hat;
        for (int i = 0; i < 2 && left > 0; ++i) {
            const double part = std::min(left, uncovered_);
            for (std::size_t c = 0; c < 3; ++c)
                layer_[c] -= part * std::min(f.taken[c] / f.coverage, 1.0);
            uncovered_ -= part;
            left -= part;
            if (uncovered_ > 0) return;
            for (std::size_t c = 0; c < 3; ++c) before_[c] *= std::max(layer_[c], 0.0);
            layer_ = {1, 1, 1};
            uncovered_ = 1;
        }
    }
    double through(std::size_t c) const { return before_[c] * std::max(layer_[c], 0.0); }

  private:
    bool multiply_;
    double uncovered_ = 1;
    std::array<double, 3> layer_{1, 1, 1}, before_{1, 1, 1};
};

/// What one level sees around a place: surfaces in order, and what they take whole.
struct Seen {
    std::vector<std::pair<double, MlsmFragment>> surfaces;  ///< filter size, opacity
    std::array<double, 3> whole{1, 1, 1};
};

class Lookup {
  public:
    Lookup(const PlaneReceiver& receiver, const ViewGeometry& view,
           const visibility::MlsmLevels& levels, const std::vector<std::vector<MlsmList>>& lists,
           const MlsmLookupReference& settings)
        : r_(receiver), view_(view), levels_(levels), lists_(lists), s_(settings) {
        const double middle = 0.5 * view.resolution;
        w_ = view.near / r_.origin.z;
        a_ = view.focal() * r_.origin.x / r_.origin.z + middle;
        b_ = view.focal() * r_.origin.y / r_.origin.z + middle;
        slope_ = std::abs(planeDepth(a_ + 1, b_) - planeDepth(a_, b_)) +
                 std::abs(planeDepth(a_, b_ + 1) - planeDepth(a_, b_));
    }

    std::array<double, 3> part(double offset) const {
        const auto& p = levels_.params;
        std::vector<Seen> seen(static_cast<std::size_t>(p.levels));
        for (int level = 0; level < p.levels; ++level) {
            const double size = offset * p.width[level] * (level ? 1 : 0.5);
            seen[static_cast<std::size_t>(level)] =
                look(level, a_ + s_.stepX * size, b_ + s_.stepY * size);
        }
        return s_.multiply ? product(seen) : sum(seen);
    }

    double hat(int level, double size) const {
        const auto& p = levels_.params;
        const double width = p.width[level];
        if (size <= width)
            return level == 0
                       ? 1
                       : std::max((size - p.width[level - 1]) / (width - p.width[level - 1]), 0.0);
        return level + 1 == p.levels
                   ? 1
                   : std::max((p.width[level + 1] - size) / (p.width[level + 1] - width), 0.0);
    }

  private:
    /// near / z of the receiver's plane on the ray through a point of the map.
    double planeDepth(double u, double v) const {
        const double middle = 0.5 * view_.resolution;
        const glm::dvec3 ray((u - middle) / view_.focal(), (v - middle) / view_.focal(), 1);
        const double towards = glm::dot(r_.normal, r_.origin);
        return towards < 0 ? view_.near * glm::dot(r_.normal, ray) / towards : w_;
    }

    Seen look(int level, double u, double v) const {
        const auto& p = levels_.params;
        const int size = p.size[level];
        const double x = std::clamp((u - p.origin[level]) / p.spacing[level], 0.0, size - 1.0);
        const double y = std::clamp((v - p.origin[level]) / p.spacing[level], 0.0, size - 1.0);
        std::array<MlsmList, 4> taps;
        for (int i = 0; i < 4; ++i) {
            const int column = std::min(static_cast<int>(x) + i % 2, size - 1);
            const int row = std::min(static_cast<int>(y) + i / 2, size - 1);
            const double fx = x - std::floor(x), fy = y - std::floor(y);
            const double weight = (i % 2 ? fx : 1 - fx) * (i / 2 ? fy : 1 - fy);
            const double plane = planeDepth(p.origin[level] + column * p.spacing[level],
                                            p.origin[level] + row * p.spacing[level]);
            const double limit = std::max(w_, plane) + w_ * s_.constantTexels / view_.focal() +
                                 slope_ * 0.5 * s_.slopeBias * std::exp2(level);
            const auto at = static_cast<std::size_t>(row * size + column);
            for (const auto& f : lists_[static_cast<std::size_t>(level)][at])
                if (f.depth > limit) taps[static_cast<std::size_t>(i)].push_back(scaled(f, weight));
        }
        return surfacesOf(level, taps);
    }

    /// Repeatedly the first fragments of those lists whose first ones are near the nearest.
    Seen surfacesOf(int level, std::array<MlsmList, 4>& taps) const {
        const auto& p = levels_.params;
        const double perDepth = s_.reach > 0 ? 1 / s_.reach : 0;
        const double together = kCluster * p.width[level] * perDepth;
        const double farthest = level ? w_ + kBehind * p.width[level - 1] * perDepth : 0;
        Seen seen;
        Light whole(s_.multiply);
        for (;;) {
            double front = -1;
            for (const auto& list : taps)
                if (!list.empty()) front = std::max(front, list[0].depth);
            if (front <= farthest) break;
            MlsmFragment surface;
            for (auto& list : taps) {
                if (list.empty() || list[0].depth < front - together) continue;
                surface.depth += list[0].depth * list[0].coverage;
                add(surface, list[0]);
                list.erase(list.begin());
            }
            if (surface.coverage <= 0) continue;
            surface.depth /= surface.coverage;
            seen.surfaces.emplace_back((surface.depth - w_) * s_.reach, surface);
            whole.take(surface, 1);
        }
        for (std::size_t c = 0; c < 3; ++c) seen.whole[c] = whole.through(c);
        return seen;
    }

    /// Levels that answer for something bound what comes through.
    std::array<double, 3> bounded(const std::vector<Seen>& seen,
                                  const std::array<double, 3>& through) const {
        const int levels = levels_.params.levels;
        std::vector<bool> answers(seen.size() + 1, false);
        for (int level = 0; level < levels; ++level)
            for (const auto& [size, surface] : seen[static_cast<std::size_t>(level)].surfaces) {
                const double h = hat(level, size);
                if (h <= 0) continue;
                answers[static_cast<std::size_t>(level)] = true;
                if (h >= 1) continue;
                const int other = size < levels_.params.width[level] ? level - 1 : level + 1;
                answers[static_cast<std::size_t>(other)] = true;
            }
        std::array<double, 3> most{0, 0, 0}, result = through;
        for (std::size_t level = 0; level < seen.size(); ++level)
            for (std::size_t c = 0; c < 3 && answers[level]; ++c)
                most[c] = std::max(most[c], seen[level].whole[c]);
        for (std::size_t c = 0; c < 3; ++c)
            if (through[c] < 1) result[c] = std::min(through[c], most[c]);
        return result;
    }

    std::array<double, 3> sum(const std::vector<Seen>& seen) const {
        Light light(false);
        for (int level = levels_.params.levels - 1; level >= 0; --level)
            for (const auto& [size, surface] : seen[static_cast<std::size_t>(level)].surfaces)
                if (hat(level, size) > 0) light.take(surface, hat(level, size));
        return bounded(seen, {light.through(0), light.through(1), light.through(2)});
    }

    /// Filter sizes between two levels' widths are one factor: the two levels' shares added.
    std::array<double, 3> product(const std::vector<Seen>& seen) const {
        std::array<double, 3> through{1, 1, 1};
        for (int gap = -1; gap < levels_.params.levels; ++gap)  // from level `gap` to the next
            for (std::size_t c = 0; c < 3; ++c) {
                double taken = 0;
                for (const int level : {gap, gap + 1}) {
                    if (level < 0 || level >= levels_.params.levels) continue;
                    double open = 1;
                    for (const auto& [size, s] : seen[static_cast<std::size_t>(level)].surfaces)
                        if ((size < levels_.params.width[level]) == (level == gap + 1))
                            open *= std::max(1 - s.taken[c] * hat(level, size), 0.0);
                    taken += 1 - open;
                }
                through[c] *= 1 - std::min(taken, 1.0);
            }
        return bounded(seen, through);
    }

    const PlaneReceiver& r_;
    const ViewGeometry& view_;
    const visibility::MlsmLevels& levels_;
    const std::vector<std::vector<MlsmList>>& lists_;
    const MlsmLookupReference& s_;
    double w_ = 0, a_ = 0, b_ = 0, slope_ = 0;
};

}  // namespace

std::array<double, 3> mlsmVisibilityReference(const PlaneReceiver& receiver,
                                              const ViewGeometry& view,
                                              const visibility::MlsmLevels& levels,
                                              const std::vector<std::vector<MlsmList>>& lists,
                                              const MlsmLookupReference& settings) {
    const Lookup lookup(receiver, view, levels, lists, settings);
    std::array<double, 3> lit{0, 0, 0};
    for (int part = 0; part < settings.parts; ++part) {
        const auto through = lookup.part(part - 0.5 * (settings.parts - 1));
        for (std::size_t c = 0; c < 3; ++c) lit[c] += through[c] / settings.parts;
    }
    // Points of the light above the receiver's plane, counted
    constexpr int kSide = 256;
    double above = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        const glm::dvec3 point(((i % kSide + 0.5) / kSide * 2 - 1) * view.halfWidth,
                               ((i / kSide + 0.5) / kSide * 2 - 1) * view.halfHeight, 0);
        above += glm::dot(receiver.normal, point - receiver.origin) > 0 ? 1 : 0;
    }
    above /= kSide * kSide;
    for (auto& value : lit) value = std::min(value, above);
    return lit;
}

}  // namespace penumbra::tests
