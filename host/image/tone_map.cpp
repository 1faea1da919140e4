// SPDX-License-Identifier: MIT
#include "host/image/tone_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host/image/srgb.h"

namespace penumbra::image {
namespace {

constexpr float kBackground = 0.045F;
constexpr int kSteps = 16384;

/// sRGB bytes over linear [0, 1]; steps are finer than a byte everywhere.
const std::array<std::uint8_t, kSteps + 1>& srgbBytes() {
    static const auto table = [] {
        std::array<std::uint8_t, kSteps + 1> bytes{};
        for (int i = 0; i <= kSteps; ++i) {
            const double v = static_cast<double>(i) / kSteps;
            bytes[static_cast<std::size_t>(i)] =
                static_cast<std::uint8_t>(std::lround(srgbFromLinear(v) * 255));
        }
        return bytes;
    }();
    return table;
}

}  // namespace

void pbrNeutral(float (&rgb)[3]) {
    constexpr float start = 0.8F - 0.04F, desaturation = 0.15F;
    const float lowest = std::min({rgb[0], rgb[1], rgb[2]});
    const float offset = lowest < 0.08F ? lowest - 6.25F * lowest * lowest : 0.04F;
    for (float& c : rgb) c -= offset;
    const float peak = std::max({rgb[0], rgb[1], rgb[2]});
    if (peak < start) return;
    constexpr float range = 1 - start;
    const float newPeak = 1 - range * range / (peak + range - start);
    for (float& c : rgb) c *= newPeak / peak;
    const float mix = 1 - 1 / (desaturation * (peak - newPeak) + 1);
    for (float& c : rgb) c += (newPeak - c) * mix;
}

void toneMapPixel(float (&rgb)[3], float alpha, float gain) {
    if (std::isnan(rgb[0]) || std::isnan(rgb[1]) || std::isnan(rgb[2]) || std::isnan(alpha)) {
        for (float& c : rgb) c = std::numeric_limits<float>::quiet_NaN();
        return;
    }
    const float uncovered = kBackground * (1 - std::clamp(alpha, 0.0F, 1.0F));
    for (float& c : rgb) c = std::clamp(c * gain + uncovered, 0.0F, 1e30F);
    pbrNeutral(rgb);
    for (float& c : rgb) c = std::clamp(c, 0.0F, 1.0F);
}

std::vector<std::uint8_t> toneMap(const Frame& frame) {
    const auto& table = srgbBytes();
    const auto exposure = static_cast<float>(frame.exposure);
    const std::size_t pixels = frame.rgba.size() / 4;
    std::vector<std::uint8_t> bytes(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const float* in = &frame.rgba[4 * i];
        float rgb[3] = {in[0], in[1], in[2]};
        toneMapPixel(rgb, in[3], exposure);
        for (std::size_t c = 0; c < 3; ++c) {
            const float shown = rgb[c] >= 0 ? rgb[c] : 0.0F;  // NaN becomes 0
            bytes[3 * i + c] = table[static_cast<std::size_t>(std::lround(shown * kSteps))];
        }
    }
    return bytes;
}

}  // namespace penumbra::image
