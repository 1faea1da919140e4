// SPDX-License-Identifier: MIT
#include "tests/reference/essm_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

constexpr int kTaps = 8;

double warped(double z, const EssmReference& settings) {
    return std::clamp((z - settings.nearZ) / settings.range, 0.0, 1.0);
}

EssmLevel halved(const EssmLevel& below) {
    EssmLevel level;
    level.size = (below.size + 1) / 2;
    for (int y = 0; y < level.size; ++y)
        for (int x = 0; x < level.size; ++x) {
            double exponential = 0, depth = 0;
            for (const int row : {2 * y, 2 * y + 1})
                for (const int column : {2 * x, 2 * x + 1}) {
                    const auto at =
                        static_cast<std::size_t>(std::min(row, below.size - 1) * below.size +
                                                 std::min(column, below.size - 1));
                    exponential += below.exponentials[at] / 4;
                    depth += below.depths[at] / 4;
                }
            level.exponentials.push_back(exponential);
            level.depths.push_back(depth);
        }
    return level;
}

struct BoxMeans {
    double lit = 0, blockers = 0;
    bool certain = true;
};

class Lookup {
  public:
    Lookup(const PlaneReceiver& receiver, const ViewGeometry& view,
           const std::vector<EssmLevel>& pyramid, const EssmReference& settings)
        : r_(receiver), view_(view), pyramid_(pyramid), settings_(settings) {
        const double middle = 0.5 * view.resolution;
        u_ = view.focal() * r_.origin.x / r_.origin.z + middle;
        v_ = view.focal() * r_.origin.y / r_.origin.z + middle;
        // d near/z = -near / z^2 dz: what a step to the next texel changes c d by
        const double steepness =
            settings.exponent * view.near / settings.range / std::pow(view.near / r_.origin.z, 2);
        slopeX_ = steepness * (planeDepth(u_ + 1, v_) - planeDepth(u_, v_));
        slopeY_ = steepness * (planeDepth(u_, v_ + 1) - planeDepth(u_, v_));
    }
    /// Means over the box where the cone from the receiver to the light passes distance z.
    BoxMeans box(const glm::dvec2& radius) const {
        const double share = std::max(2 * std::max(radius.x, radius.y) / kTaps, 1.0);
        const int last = static_cast<int>(pyramid_.size()) - 1;
        const int lower = std::clamp(static_cast<int>(std::floor(std::log2(share))), 0, last);
        const int upper = std::min(lower + 1, last);
        const double blend = std::clamp(share / std::exp2(lower) - 1, 0.0, 1.0);
        BoxMeans means;
        for (int i = 0; i < kTaps; ++i)
            for (int k = 0; k < kTaps; ++k) {
                const double u = u_ + radius.x * ((2 * k + 1.0) / kTaps - 1);
                const double v = v_ + radius.y * ((2 * i + 1.0) / kTaps - 1);
                addTexel(lower, u, v, (1 - blend) / (kTaps * kTaps), means);
                addTexel(upper, u, v, blend / (kTaps * kTaps), means);
            }
        return means;
    }

  private:
    /// near / z of the receiver's plane at a point of the map; where the light's centre does not
    /// see the plane, of the receiver.
    double planeDepth(double u, double v) const {
        const double facing = -glm::dot(r_.normal, r_.origin);
        if (facing <= 0) return view_.near / r_.origin.z;
        const double middle = 0.5 * view_.resolution;
        const glm::dvec3 ray((u - middle) / view_.focal(), (v - middle) / view_.focal(), 1);
        return -view_.near * glm::dot(r_.normal, ray) / facing;
    }
    /// Mean of e^(s t) over t in [-1, 1].
    static double meanExponential(double s) {
        s = std::min(std::abs(s), 40.0);
        return s < 1e-6 ? 1 : std::sinh(s) / s;
    }
    void addTexel(int level, double u, double v, double weight, BoxMeans& means) const {
        const auto& texels = pyramid_[static_cast<std::size_t>(level)];
        const double size = std::exp2(level);
        for (const double place : {u / size, v / size})
            if (place > 0.5 && place < texels.size - 0.5 &&
                std::abs(place - std::round(place)) * size < 2e-4)
                means.certain = false;
        const int column = std::clamp(static_cast<int>(std::floor(u / size)), 0, texels.size - 1);
        const int row = std::clamp(static_cast<int>(std::floor(v / size)), 0, texels.size - 1);
        const double plane = planeDepth((column + 0.5) * size, (row + 0.5) * size);
        // The bias moves the receiver towards the light
        const double z =
            view_.near / std::max(plane, 1e-6) * (1 - settings_.constantTexels / view_.focal()) -
            settings_.constantMetres;
        const double receiver = warped(z, settings_);
        const auto at = static_cast<std::size_t>(row * texels.size + column);
        // e^(c d) of a slope is larger on average than at the texel's centre; the last depth is
        // flat
        const double excess = receiver >= 1 ? 1
                                            : meanExponential(slopeX_ * size / 2) *
                                                  meanExponential(slopeY_ * size / 2);
        const double passed = std::min(
            texels.exponentials[at] * std::exp(-settings_.exponent * receiver) / excess, 1.0);
        const double blocked =
            std::clamp(texels.depths[at] - passed * receiver, 0.0, (1 - passed) * receiver);
        means.lit += weight * passed;
        means.blockers += weight * blocked;
    }

    const PlaneReceiver& r_;
    const ViewGeometry& view_;
    const std::vector<EssmLevel>& pyramid_;
    const EssmReference& settings_;
    double u_ = 0, v_ = 0, slopeX_ = 0, slopeY_ = 0;
};

/// Share of 4 x 4 points of the light that lie over the receiver's plane.
double shareAbove(const PlaneReceiver& receiver, const glm::dvec2& halfSize, bool& certain) {
    double above = 0;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) {
            const glm::dvec3 point((k - 1.5) / 2 * halfSize.x, (i - 1.5) / 2 * halfSize.y, 0);
            const double rise = glm::dot(receiver.normal, point - receiver.origin);
            if (std::abs(rise) < 1e-5) certain = false;
            above += rise > 0 ? 1.0 / 16 : 0;
        }
    return above;
}

}  // namespace

std::vector<EssmLevel> essmPyramid(const std::vector<double>& casters,
                                   const std::vector<double>& receivers, int size, double near,
                                   const EssmReference& settings) {
    EssmLevel base;
    base.size = size;
    for (std::size_t i = 0; i < casters.size(); ++i) {
        const double w = casters[i] > 0 ? casters[i] : receivers[i];
        base.depths.push_back(w > 0 ? warped(near / w, settings) : 1);
        base.exponentials.push_back(std::exp(settings.exponent * base.depths.back()));
    }
    std::vector<EssmLevel> pyramid{base};
    while (pyramid.back().size > 1) pyramid.push_back(halved(pyramid.back()));
    return pyramid;
}

EssmOutcome essmReference(const PlaneReceiver& receiver, const ViewGeometry& view,
                          const std::vector<EssmLevel>& pyramid, const EssmReference& settings) {
    const Lookup lookup(receiver, view, pyramid, settings);
    const double z = receiver.origin.z;
    // Radius in texels of the cone from receiver to light where it passes a distance
    const auto radiusAt = [&](double distance) {
        return settings.halfSize * (1 - distance / z) / distance * view.focal();
    };
    const auto search = lookup.box(radiusAt(view.near));
    const double share = 1 - search.lit;
    EssmOutcome out;
    out.certain = search.certain && std::abs(share - 1e-3) > 2e-4;
    double lit = 1;
    if (share > 1e-3) {
        const double blocker =
            std::max(settings.nearZ + search.blockers / share * settings.range, view.near);
        const auto radius = radiusAt(std::min(blocker, z));
        const auto filter = lookup.box(glm::max(radius, glm::dvec2(settings.leastRadius)));
        out.certain = out.certain && filter.certain;
        lit = filter.lit;
    }
    lit = std::max(lit - settings.leak, 0.0) / (1 - settings.leak);
    out.visibility = std::min(lit, shareAbove(receiver, settings.halfSize, out.certain));
    return out;
}

}  // namespace penumbra::tests
