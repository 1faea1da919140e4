// SPDX-License-Identifier: MIT
// With s = a + b and d = a - b, whose means are m_s, m_d and variances v_s, v_d,
//   mean(a)^2 + mean(b)^2 = (m_s^2 + m_d^2) / 2         var(a) + var(b) = (v_s + v_d) / 2
//   mean(a) mean(b)       = (m_s^2 - m_d^2) / 4         cov(a, b)       = (v_s - v_d) / 4
// so that SSIM = (1 - m_d^2 / (mean(a)^2 + mean(b)^2 + C1)) (1 - v_d / (var(a) + var(b) + C2)):
// four filters instead of five, exactly 1 for equal pictures, and exactly symmetric.
#include "host/metrics/ssim.h"

namespace penumbra::metrics {
namespace {

constexpr float kC1 = 0.01F * 0.01F, kC2 = 0.03F * 0.03F;
constexpr double kSigma = 1.5;
constexpr int kRadius = 5;

/// a - b and a + b - 1 of the luminances. Without the 1, which variances do not see, the squares
/// would be larger than the variances by more than float has digits for.
void loadLuminances(const Picture& a, const Picture& b, Plane& difference, Plane& sum) {
    constexpr float grey[] = {1}, rgb[] = {0.2126F, 0.7152F, 0.0722F};
    const float* weights = a.planes.size() == 1 ? grey : rgb;
    difference.assign(a.planes[0].size(), 0.0F);
    sum.assign(a.planes[0].size(), -1.0F);
    for (std::size_t c = 0; c < a.planes.size(); ++c)
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const float va = a.planes[c][i], vb = b.planes[c][i];
            const float inA = comparableValue(va, vb), inB = comparableValue(vb, va);
            difference[i] += weights[c] * (inA - inB);
            sum[i] += weights[c] * (inA + inB);
        }
}

/// Means and variances in the window around each pixel. `values` becomes their squares.
void windowMoments(Plane& values, int width, Plane& scratch, Plane& mean, Plane& variance) {
    const auto exact = gaussianTaps(kSigma, kRadius);
    const Taps window(exact.begin(), exact.end());
    filterSeparable(values, width, window, window, Border::renormalise, scratch, mean);
    for (float& v : values) v *= v;
    filterSeparable(values, width, window, window, Border::renormalise, scratch, variance);
    for (std::size_t i = 0; i < mean.size(); ++i) variance[i] -= mean[i] * mean[i];
}

}  // namespace

MetricMap ssim(const Picture& a, const Picture& b, const std::vector<bool>& mask) {
    requireComparable(a, b, mask);
    Plane difference, sum, scratch, meanD, varianceD, meanS, varianceS;
    loadLuminances(a, b, difference, sum);
    windowMoments(difference, a.width, scratch, meanD, varianceD);
    windowMoments(sum, a.width, scratch, meanS, varianceS);
    MetricMap result;
    result.map.resize(meanD.size());
    for (std::size_t i = 0; i < meanD.size(); ++i) {
        const float squareD = meanD[i] * meanD[i], s = meanS[i] + 1;
        const float luminance = 1 - squareD / ((s * s + squareD) / 2 + kC1);
        const float structure = 1 - varianceD[i] / ((varianceS[i] + varianceD[i]) / 2 + kC2);
        result.map[i] = luminance * structure;
    }
    result.mean = maskedMean(result.map, mask, 1);
    return result;
}

}  // namespace penumbra::metrics
