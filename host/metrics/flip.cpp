// SPDX-License-Identifier: MIT
// Source: [FLIP], see flip.h. The names are its names.
//   sRGB --> Y C_x C_z --> contrast sensitivity --> clamped RGB --> L*a*b* --> Hunt --> HyAB
//            Y --> edges and points                 colour difference ^ (1 - feature difference)
// Y C_x C_z are kept without the factors and the offset of the paper (116, 500, 200, -16): its
// filters sum to 1, so that these commute with them and cancel on the way back.
#include "host/metrics/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "host/image/srgb.h"
#include "runtime/error.h"

namespace penumbra::metrics {
namespace {

/// Contrast sensitivity: sums of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees
/// ([FLIP] table 1). Where a is 0 there is one Gaussian.
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity kAchromatic{1, 0.0047, 0, 1e-5}, kRedGreen{1, 0.0053, 0, 1e-5},
    kBlueYellow{34.1, 0.04, 13.5, 0.025};
constexpr double kWidestB = 0.04;

constexpr double kFeatureWidth = 0.082;                        ///< w, degrees
constexpr float kColourExponent = 0.7F, kFeaturePower = 0.5F;  ///< q_c, q_f
constexpr float kKnee = 0.4F, kKneeValue = 0.95F;              ///< p_c, p_t

/// X / X_n, Y / Y_n, Z / Z_n from linear RGB and back, for the primaries of BT.709 and white = RGB
/// (1, 1, 1): rows sum to 1.
struct ColourSpace {
    glm::mat3 xyzFromRgb, rgbFromXyz;
    ColourSpace() {
        glm::dmat3 columns(0.4123908, 0.2126390, 0.0193308, 0.3575843, 0.7151687, 0.1191948,
                           0.1804808, 0.0721923, 0.9505322);
        const glm::dvec3 white = columns * glm::dvec3(1);
        for (int c = 0; c < 3; ++c) columns[c] /= white;
        xyzFromRgb = glm::mat3(columns);
        rgbFromXyz = glm::mat3(glm::inverse(columns));
    }
};

const ColourSpace& colourSpace() {
    static const ColourSpace space;
    return space;
}

/// L*a*b* with the Hunt adjustment: a* and b* fade in the dark. `rgb` is linear in [0, 1].
glm::vec3 huntLab(const glm::vec3& rgb) {
    const auto f = [](float t) {
        constexpr float delta = 6.0F / 29;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0F / 29;
    };
    const glm::vec3 xyz = colourSpace().xyzFromRgb * rgb;
    const float fx = f(xyz.x), fy = f(xyz.y), fz = f(xyz.z);
    const float lightness = 116 * fy - 16, hunt = 0.01F * lightness;
    return {lightness, hunt * 500 * (fx - fy), hunt * 200 * (fy - fz)};
}

/// HyAB distance: city block in lightness, Euclid in chroma; then the exponent q_c.
float colourDistance(const glm::vec3& p, const glm::vec3& q) {
    const float da = p.y - q.y, db = p.z - q.z;
    return std::pow(std::abs(p.x - q.x) + std::sqrt(da * da + db * db), kColourExponent);
}

/// Distances up to p_c of the largest one (green to blue) fill [0, p_t], the rest [p_t, 1].
float redistribute(float distance) {
    static const float largest = colourDistance(huntLab({0, 1, 0}), huntLab({0, 0, 1}));
    const float knee = kKnee * largest;
    return distance < knee ? kKneeValue / knee * distance
                           : kKneeValue + (distance - knee) / (largest - knee) * (1 - kKneeValue);
}

Taps floatTaps(const std::vector<double>& taps) {
    return {taps.begin(), taps.end()};
}

/// A sensitivity as separable Gaussians and the share of each; the shares sum to 1.
struct ColourFilter {
    Taps first, second;
    float secondShare = 0;
    ColourFilter(const Sensitivity& s, double pixelsPerDegree) {
        const auto sigma = [&](double b) {
            return std::sqrt(b / 2) / std::numbers::pi * pixelsPerDegree;
        };
        const int radius = static_cast<int>(std::ceil(3 * sigma(kWidestB)));
        first = floatTaps(gaussianTaps(sigma(s.b1), radius));
        second = floatTaps(gaussianTaps(sigma(s.b2), radius));
        const auto weight = [&](double a, double b) {
            double sum = 0;
            for (int x = -radius; x <= radius; ++x)
                sum += std::exp(-x * x / (2 * sigma(b) * sigma(b)));
            return a * std::sqrt(std::numbers::pi / b) * sum * sum;
        };
        const double w1 = weight(s.a1, s.b1), w2 = weight(s.a2, s.b2);
        secondShare = static_cast<float>(w2 / (w1 + w2));
    }

    void run(Plane& plane, int width, Plane& scratch, Plane& part) const {
        if (secondShare > 0)
            filterSeparable(plane, width, second, second, Border::replicate, scratch, part);
        filterSeparable(plane, width, first, first, Border::replicate, scratch, plane);
        if (secondShare > 0)
            for (std::size_t i = 0; i < plane.size(); ++i)
                plane[i] += secondShare * (part[i] - plane[i]);
    }
};

/// A Gaussian, its first and its second derivative; the positive weights of each sum to 1 and the
/// negative ones to -1, in one dimension and so also in two.
struct FeatureFilters {
    Taps smooth, edge, point;
    explicit FeatureFilters(double pixelsPerDegree) {
        const double sigma = 0.5 * kFeatureWidth * pixelsPerDegree;
        const int radius = static_cast<int>(std::ceil(3 * sigma));
        const auto gaussian = gaussianTaps(sigma, radius);
        std::vector<double> first, second;
        int x = -radius;
        for (const double g : gaussian) {
            first.push_back(-x * g);
            second.push_back((x * x / (sigma * sigma) - 1) * g);
            ++x;
        }
        smooth = floatTaps(gaussian);
        edge = floatTaps(balanced(first));
        point = floatTaps(balanced(second));
    }

    static std::vector<double> balanced(std::vector<double> taps) {
        double positive = 0, negative = 0;
        for (const double tap : taps) (tap > 0 ? positive : negative) += std::abs(tap);
        for (double& tap : taps) tap /= tap > 0 ? positive : negative;
        return taps;
    }

    /// Strength of the filter's answer along both axes.
    Plane strength(const Plane& luminance, int width, const Taps& taps, Plane& scratch) const {
        Plane across, down;
        filterSeparable(luminance, width, taps, smooth, Border::replicate, scratch, across);
        filterSeparable(luminance, width, smooth, taps, Border::replicate, scratch, down);
        for (std::size_t i = 0; i < across.size(); ++i)
            across[i] = std::sqrt(across[i] * across[i] + down[i] * down[i]);
        return across;
    }
};

/// A picture as it is seen: Hunt-adjusted L*a*b* after the contrast sensitivity, and its features.
struct Seen {
    std::array<Plane, 3> lab;
    Plane edges, points;
};

std::array<Plane, 3> opponentOf(const Picture& picture, const Picture& other) {
    const auto& matrix = colourSpace().xyzFromRgb;
    const std::size_t count = picture.planes[0].size();
    std::array<Plane, 3> opponent;
    for (auto& plane : opponent) plane.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        glm::vec3 rgb(0);
        for (std::size_t c = 0; c < picture.planes.size(); ++c) {
            const float value = comparableValue(picture.planes[c][i], other.planes[c][i]);
            rgb[static_cast<int>(c)] =
                picture.encoding == Encoding::srgb ? image::linearFromSrgb(value) : value;
        }
        if (picture.planes.size() == 1) rgb = glm::vec3(rgb.x);
        const glm::vec3 xyz = matrix * rgb;
        opponent[0][i] = xyz.y;
        opponent[1][i] = xyz.x - xyz.y;
        opponent[2][i] = xyz.y - xyz.z;
    }
    return opponent;
}

Seen see(const Picture& picture, const Picture& other, double pixelsPerDegree) {
    Seen seen;
    Plane scratch, part;
    const int width = picture.width;
    seen.lab = opponentOf(picture, other);
    const FeatureFilters features(pixelsPerDegree);
    seen.edges = features.strength(seen.lab[0], width, features.edge, scratch);
    seen.points = features.strength(seen.lab[0], width, features.point, scratch);
    const Sensitivity sensitivities[] = {kAchromatic, kRedGreen, kBlueYellow};
    for (std::size_t c = 0; c < 3; ++c)
        ColourFilter(sensitivities[c], pixelsPerDegree).run(seen.lab[c], width, scratch, part);
    const auto& matrix = colourSpace().rgbFromXyz;
    for (std::size_t i = 0; i < seen.edges.size(); ++i) {
        const float y = seen.lab[0][i];
        const glm::vec3 rgb = matrix * glm::vec3(seen.lab[1][i] + y, y, y - seen.lab[2][i]);
        const glm::vec3 lab = huntLab(glm::clamp(rgb, 0.0F, 1.0F));
        for (int c = 0; c < 3; ++c) seen.lab[static_cast<std::size_t>(c)][i] = lab[c];
    }
    return seen;
}

/// Delta E_f in [0, 1].
float featureDifference(const Seen& r, const Seen& t, std::size_t i) {
    const float edges = std::abs(r.edges[i] - t.edges[i]);
    const float points = std::abs(r.points[i] - t.points[i]);
    const float larger = std::max(edges, points) / std::numbers::sqrt2_v<float>;
    return std::min(std::pow(larger, kFeaturePower), 1.0F);
}

}  // namespace

MetricMap flip(const Picture& reference, const Picture& test, const std::vector<bool>& mask,
               const FlipSettings& settings) {
    requireComparable(reference, test, mask);
    const double pixelsPerDegree = settings.pixelsPerDegree;
    require(pixelsPerDegree >= 1 && pixelsPerDegree <= 1000,
            "{} pixels per degree are outside of 1 to 1000", pixelsPerDegree);
    const Seen r = see(reference, test, pixelsPerDegree);
    const Seen t = see(test, reference, pixelsPerDegree);
    MetricMap result;
    result.map.resize(r.edges.size());
    for (std::size_t i = 0; i < result.map.size(); ++i) {
        const float colour = redistribute(colourDistance({r.lab[0][i], r.lab[1][i], r.lab[2][i]},
                                                         {t.lab[0][i], t.lab[1][i], t.lab[2][i]}));
        result.map[i] = std::pow(colour, 1 - featureDifference(r, t, i));
    }
    result.mean = maskedMean(result.map, mask, 0);
    return result;
}

}  // namespace penumbra::metrics
