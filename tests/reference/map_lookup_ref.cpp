// SPDX-License-Identifier: MIT
#include "tests/reference/map_lookup_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {
namespace {

/// Shadow tests of one view of one receiver.
class ViewTests {
  public:
    ViewTests(const PlaneReceiver& receiver, const ViewGeometry& view, const glm::dvec2& sample,
              const std::vector<double>& map, const LookupSettings& settings)
        : r_(receiver), view_(view), sample_(sample, 0), map_(map), settings_(settings) {
        const glm::dvec3 p = r_.origin - sample_;
        u_ = view_.focal() * p.x / p.z + 0.5 * view_.resolution;
        v_ = view_.focal() * p.y / p.z + 0.5 * view_.resolution;
    }
    double u() const { return u_; }
    double v() const { return v_; }
    /// n . (sample - origin): what rises over the receiver's plane sees it.
    double rise() const { return glm::dot(r_.normal, sample_ - r_.origin); }

    /// Adds the test of a texel, with a weight, to what is hidden for sure and perhaps.
    void test(int column, int row, int weight, HiddenWeight& hidden) const {
        if (column < 0 || row < 0 || column >= view_.resolution || row >= view_.resolution) return;
        const double stored = map_[static_cast<std::size_t>(row * view_.resolution + column)];
        const double limit = std::max(biasedDepth(column, row), 0.0);
        // Float carries a receiver's depth to a few ulps, times what the plane's slope makes of
        // 2e-4 texels
        const double doubt = 1e-6 + 2e-4 * slope();
        if (stored > limit + doubt) hidden.low += weight;
        if (stored > limit - doubt && stored > 0) hidden.high += weight;
    }

  private:
    /// near / z where the ray through a texel's centre meets the receiver's plane.
    double planeDepth(double column, double row) const {
        const double middle = 0.5 * view_.resolution;
        const glm::dvec3 ray((column + 0.5 - middle) / view_.focal(),
                             (row + 0.5 - middle) / view_.focal(), 1);
        return view_.near * glm::dot(r_.normal, ray) / glm::dot(r_.normal, r_.origin - sample_);
    }
    /// What the plane's depth changes by in a step to the next column and row.
    double slope() const {
        return std::abs(planeDepth(1, 0) - planeDepth(0, 0)) +
               std::abs(planeDepth(0, 1) - planeDepth(0, 0));
    }
    double biasedDepth(int column, int row) const {
        // A stored point lies up to half a texel off its texel's centre
        const double sloped = 0.5 * settings_.slopeBias * slope();
        // dz of constantTexels footprints z / F and of metres: dw = near / z^2 dz
        const double z = r_.origin.z;
        const double metres =
            settings_.constantTexels * z / view_.focal() + settings_.constantMetres;
        return planeDepth(column, row) + sloped + view_.near / (z * z) * metres + settings_.quantum;
    }

    const PlaneReceiver& r_;
    const ViewGeometry& view_;
    glm::dvec3 sample_;
    const std::vector<double>& map_;
    const LookupSettings& settings_;
    double u_ = 0, v_ = 0;
};

double fraction(double value) {
    return value - std::floor(value);
}

/// Distance to the next multiple of `step`.
double toBorder(double value, double step) {
    const double f = fraction(value / step);
    return std::min(f, 1 - f) * step;
}

}  // namespace

ReceiverReference receiverReference(const PlaneReceiver& receiver, const ViewGeometry& view,
                                    bool covered, bool receives) {
    ReceiverReference r;
    if (!covered) return r;
    const auto& p = receiver.origin;
    // The light's highest corner over the receiver's plane
    double highest = -1e300, margin = 1e300;
    for (const double x : {-view.halfWidth, view.halfWidth})
        for (const double y : {-view.halfHeight, view.halfHeight}) {
            highest = std::max(highest, glm::dot(receiver.normal, glm::dvec3(x, y, 0) - p));
            for (const double offset : {p.x - x, p.y - y})
                margin =
                    std::min(margin, 0.5 * view.resolution - view.focal() * std::abs(offset) / p.z);
        }
    r.doubt = std::min(std::abs(p.z), std::abs(highest));
    if (p.z <= 0 || highest <= 0) return r;
    r.state = receives ? STATE_TESTED : STATE_LIT;
    r.outside = margin < 0;
    r.doubt = std::min(r.doubt, std::abs(margin));
    r.a = view.focal() * p.x / p.z + 0.5 * view.resolution;
    r.b = view.focal() * p.y / p.z + 0.5 * view.resolution;
    r.w = view.near / p.z;
    r.slopeX = view.near * receiver.normal.x / view.focal();
    r.slopeY = view.near * receiver.normal.y / view.focal();
    r.facing = -glm::dot(receiver.normal, p);
    return r;
}

HiddenWeight hiddenReference(const PlaneReceiver& receiver, const ViewGeometry& view,
                             const glm::dvec2& sample, const std::vector<double>& map,
                             const LookupSettings& settings) {
    const ViewTests tests(receiver, view, sample, map, settings);
    const bool bilinear = settings.pcf == 4;
    const int all = bilinear ? 256 : settings.pcf;
    if (std::abs(tests.rise()) < 0.02) return {0, all};  // depths run to infinity there
    if (tests.rise() < 0) return {all, all};             // below the receiver's own horizon
    // Columns of float are good for 2e-4 texels; bilinear weights come in sixteenths
    const double step = bilinear ? 1.0 / 16 : 1;
    if (std::min(toBorder(tests.u(), step), toBorder(tests.v(), step)) < 2e-4) return {0, all};
    HiddenWeight hidden;
    if (bilinear) {
        const double u = tests.u() - 0.5, v = tests.v() - 0.5;
        const int column = static_cast<int>(std::floor(u)), row = static_cast<int>(std::floor(v));
        const int right = static_cast<int>(16 * fraction(u)),
                  below = static_cast<int>(16 * fraction(v));
        tests.test(column, row, (16 - right) * (16 - below), hidden);
        tests.test(column + 1, row, right * (16 - below), hidden);
        tests.test(column, row + 1, (16 - right) * below, hidden);
        tests.test(column + 1, row + 1, right * below, hidden);
        return hidden;
    }
    const int column = static_cast<int>(std::floor(tests.u())),
              row = static_cast<int>(std::floor(tests.v()));
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            const int steps = std::abs(dx) + std::abs(dy);
            if (steps <= (settings.pcf == 1 ? 0 : settings.pcf == 5 ? 1 : 2))
                tests.test(column + dx, row + dy, 1, hidden);
        }
    return hidden;
}

double upsampleReference(const std::vector<UpsamplePixel>& image, int width, int height, int column,
                         int row) {
    const auto& centre = image[static_cast<std::size_t>(row * width + column)];
    if (!centre.tested) return 1;
    double sum = 0, weights = 0, nearest = 1, closest = 0;
    for (int y = 0; y < height; y += 2)
        for (int x = 0; x < width; x += 2) {
            const double tent =
                std::max(0.0, 2.0 - std::abs(x - column)) * std::max(0.0, 2.0 - std::abs(y - row));
            const auto& other = image[static_cast<std::size_t>(y * width + x)];
            if (tent == 0 || !other.tested) continue;
            const glm::dvec3 way = other.position - centre.position;
            const double off = glm::dot(centre.normal, way);
            const double squared = std::max(glm::dot(way, way), 1e-20);
            const double alike = std::max(0.0, glm::dot(centre.normal, other.normal) - 0.8) *
                                 std::max(0.0, 1 - 16 * off * off / squared);
            sum += tent * alike * other.value;
            weights += tent * alike;
            if (tent > closest) closest = tent, nearest = other.value;
        }
    return weights > 1e-6 ? sum / weights : nearest;
}

}  // namespace penumbra::tests
