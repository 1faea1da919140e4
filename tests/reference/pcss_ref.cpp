// SPDX-License-Identifier: MIT
#include "tests/reference/pcss_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

enum class Answer { no, yes, either };

class Taps {
  public:
    Taps(const PlaneReceiver& receiver, const ViewGeometry& view, const std::vector<double>& map,
         const PcssReference& settings)
        : r_(receiver), view_(view), map_(map), settings_(settings) {}

    /// The light sample of a tap.
    glm::dvec3 sample(const glm::dvec2& tap) const {
        const double c = std::cos(settings_.angle), s = std::sin(settings_.angle);
        return {(c * tap.x - s * tap.y) * settings_.halfSize.x,
                (s * tap.x + c * tap.y) * settings_.halfSize.y, 0};
    }
    /// Whether what the map holds, where the line to `sample` passes `distance` from the light,
    /// lies before the receiver; `stored` gets its depth.
    Answer blocked(const glm::dvec3& sample, double distance, double& stored) const {
        const double along = 1 - distance / r_.origin.z;
        const glm::dvec3 p = r_.origin + along * (sample - r_.origin);
        const double middle = 0.5 * view_.resolution;
        const double u = view_.focal() * p.x / distance + middle;
        const double v = view_.focal() * p.y / distance + middle;
        // Columns of float are good for 2e-4 texels
        if (toInteger(u) < 2e-4 || toInteger(v) < 2e-4) return Answer::either;
        const double size = view_.resolution;
        if (u < 0 || v < 0 || u >= size || v >= size) return Answer::no;
        const int column = static_cast<int>(u), row = static_cast<int>(v);
        stored = map_[static_cast<std::size_t>(row * view_.resolution + column)];
        const double limit = std::max(reference(column, row), 0.0);
        const double doubt = 1e-6 + 2e-4 * slope();
        if (std::abs(stored - limit) < doubt && stored > 0) return Answer::either;
        return stored > limit ? Answer::yes : Answer::no;
    }

  private:
    static double toInteger(double value) { return std::abs(value - std::round(value)); }
    /// near / z where a texel's ray meets the receiver's plane; where the light's centre does not
    /// see that plane, the receiver's own.
    double planeDepth(double column, double row) const {
        const double facing = -glm::dot(r_.normal, r_.origin);
        if (facing <= 0) return view_.near / r_.origin.z;
        const double middle = 0.5 * view_.resolution;
        const glm::dvec3 ray((column + 0.5 - middle) / view_.focal(),
                             (row + 0.5 - middle) / view_.focal(), 1);
        return -view_.near * glm::dot(r_.normal, ray) / facing;
    }
    double slope() const {
        return std::abs(planeDepth(1, 0) - planeDepth(0, 0)) +
               std::abs(planeDepth(0, 1) - planeDepth(0, 0));
    }
    double reference(int column, int row) const {
        const double z = r_.origin.z;
        const auto& bias = settings_.bias;
        const double metres = bias.constantTexels * z / view_.focal() + bias.constantMetres;
        const double depth = settings_.planeBias ? planeDepth(column, row) : view_.near / z;
        return depth + 0.5 * bias.slopeBias * slope() + view_.near / (z * z) * metres;
    }

    const PlaneReceiver& r_;
    const ViewGeometry& view_;
    const std::vector<double>& map_;
    const PcssReference& settings_;
};

}  // namespace

PcssOutcome pcssReference(const PlaneReceiver& receiver, const ViewGeometry& view,
                          const std::vector<double>& map, const PcssReference& settings) {
    const Taps taps(receiver, view, map, settings);
    PcssOutcome out;
    double sum = 0;
    int blockers = 0;
    for (const auto& tap : settings.search) {
        double stored = 0;
        const auto answer = taps.blocked(taps.sample(tap), view.near, stored);
        if (answer == Answer::either) out.certain = false;
        if (answer != Answer::yes) continue;
        sum += view.near / stored;
        ++blockers;
    }
    const int all = static_cast<int>(settings.filter.size());
    if (blockers) out.blocker = sum / blockers;
    if (!out.certain) {
        out.hidden = {0, all};
        return out;
    }
    // The filter lies where the mean blocker does, or a little before the receiver
    const double least = view.near / (view.near / receiver.origin.z + settings.leastSpread);
    const double distance = std::min(out.blocker, least);
    for (const auto& tap : settings.filter) {
        const glm::dvec3 sample = taps.sample(tap);
        const double rise = glm::dot(receiver.normal, sample - receiver.origin);
        double stored = 0;
        const auto answer = blockers ? taps.blocked(sample, distance, stored) : Answer::no;
        const bool unsure = std::abs(rise) < 1e-5;
        out.hidden.low += (rise < 0 && !unsure) || answer == Answer::yes;
        out.hidden.high += rise < 0 || unsure || answer != Answer::no;
    }
    return out;
}

}  // namespace penumbra::tests
