// SPDX-License-Identifier: MIT
#include "host/report/page_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/image/image_file.h"
#include "runtime/error.h"

namespace penumbra::report {
namespace {

using Colour = std::array<double, 3>;

// Dark to bright, each step of equal visual weight: black, purple, red, orange, yellow, white
constexpr std::array<Colour, 7> kHeat{{{0, 0, 4},
                                       {66, 16, 110},
                                       {147, 38, 103},
                                       {221, 81, 58},
                                       {252, 165, 10},
                                       {246, 215, 70},
                                       {252, 255, 210}}};
constexpr Colour kTooLight{33, 102, 220}, kTooDark{214, 40, 40}, kRight{247, 247, 245};
constexpr Colour kLeftOut{200, 200, 200};

Colour between(const Colour& a, const Colour& b, double t) {
    return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

Colour heat(double value) {
    const double at = std::clamp(value, 0.0, 1.0) * (kHeat.size() - 1);
    const auto step = std::min(static_cast<std::size_t>(at), kHeat.size() - 2);
    return between(kHeat[step], kHeat[step + 1], at - static_cast<double>(step));
}

void append(std::vector<std::uint8_t>& rgb, const Colour& colour) {
    for (const double c : colour) rgb.push_back(static_cast<std::uint8_t>(std::lround(c)));
}

std::string css(const Colour& c) {
    return fmt::format("rgb({:.0f} {:.0f} {:.0f})", c[0], c[1], c[2]);
}

std::string base64(const std::vector<std::uint8_t>& bytes) {
    static const char kDigits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const auto left = bytes.size() - i;
        const std::uint32_t group = static_cast<std::uint32_t>(bytes[i]) << 16 |
                                    (left > 1 ? static_cast<std::uint32_t>(bytes[i + 1]) << 8 : 0) |
                                    (left > 2 ? bytes[i + 2] : 0U);
        text += kDigits[group >> 18];
        text += kDigits[group >> 12 & 63];
        text += left > 1 ? kDigits[group >> 6 & 63] : '=';
        text += left > 2 ? kDigits[group & 63] : '=';
    }
    return text;
}

/// Mean absolute error of visibility in a square; of the pixels that count.
double errorIn(const Pictures& truth, const Pictures& frame, const Inset& square) {
    double sum = 0;
    for (int y = square.y; y < square.y + square.size; ++y)
        for (int x = square.x; x < square.x + square.size; ++x) {
            const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(truth.width) +
                            static_cast<std::size_t>(x);
            if (frame.mask.empty() || frame.mask[at])
                sum += std::abs(static_cast<double>(truth.visibility[at]) -
                                static_cast<double>(frame.visibility[at]));
        }
    return sum / (square.size * square.size);
}

}  // namespace

std::string escaped(const std::string& text) {
    std::string safe;
    for (const char c : text) {
        switch (c) {
            case '&':
                safe += "&amp;";
                break;
            case '<':
                safe += "&lt;";
                break;
            case '>':
                safe += "&gt;";
                break;
            case '"':
                safe += "&quot;";
                break;
            case '\'':
                safe += "&#39;";
                break;
            default:
                safe += c;
        }
    }
    return safe;
}

std::string pictureUri(const std::vector<std::uint8_t>& rgb, int width, int height) {
    return "data:image/png;base64," + base64(image::encodePng(rgb, width, height));
}

std::vector<std::uint8_t> errorColours(const Pictures& truth, const Pictures& frame, double full) {
    std::vector<std::uint8_t> rgb;
    for (std::size_t i = 0; i < truth.visibility.size(); ++i) {
        const double error =
            static_cast<double>(frame.visibility[i]) - static_cast<double>(truth.visibility[i]);
        const double strength = std::min(std::sqrt(std::abs(error) / full), 1.0);
        if (!frame.mask.empty() && !frame.mask[i])
            append(rgb, kLeftOut);
        else
            append(rgb, between(kRight, error > 0 ? kTooLight : kTooDark, strength));
    }
    return rgb;
}

std::vector<std::uint8_t> flipColours(const metrics::Plane& flip) {
    std::vector<std::uint8_t> rgb;
    for (const float value : flip) append(rgb, heat(static_cast<double>(value)));
    return rgb;
}

std::string errorGradient() {
    // Steps of equal error: the scale is a square root
    std::string stops;
    for (int i = -4; i <= 4; ++i)
        stops += (stops.empty() ? "" : ", ") +
                 css(between(kRight, i > 0 ? kTooLight : kTooDark, std::sqrt(std::abs(i) / 4.0)));
    return "linear-gradient(90deg, " + stops + ")";
}

std::string flipGradient() {
    std::string stops;
    for (const auto& colour : kHeat) stops += (stops.empty() ? "" : ", ") + css(colour);
    return "linear-gradient(90deg, " + stops + ")";
}

std::vector<Inset> findInsets(const Comparison& comparison, int count) {
    const auto& truth = comparison.reference.shown;
    const int size =
        std::min({std::max(comparison.width / 12, 24), comparison.width, comparison.height});
    std::vector<std::pair<double, Inset>> scored;
    for (int y = 0; y + size <= truth.height; y += std::max(size / 3, 1))
        for (int x = 0; x + size <= truth.width; x += std::max(size / 3, 1)) {
            const Inset square{x, y, size};
            double least = 1e9, most = 0;
            for (const auto& result : comparison.results) {
                if (result.shown.visibility.size() != truth.visibility.size()) return {};
                const double error = errorIn(truth, result.shown, square);
                least = std::min(least, error);
                most = std::max(most, error);
            }
            // With one contender alone: where it errs most
            scored.emplace_back(comparison.results.size() > 1 ? most - least : most, square);
        }
    std::stable_sort(scored.begin(), scored.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Inset> chosen;
    for (const auto& [score, square] : scored) {
        if (static_cast<int>(chosen.size()) == count || score <= 0) break;
        const bool apart =
            std::all_of(chosen.begin(), chosen.end(), [&, s = square](const Inset& c) {
                return std::abs(c.x - s.x) >= s.size || std::abs(c.y - s.y) >= s.size;
            });
        if (apart) chosen.push_back(square);
    }
    return chosen;
}

std::vector<std::uint8_t> cropped(const Pictures& frame, const Inset& inset) {
    std::vector<std::uint8_t> rgb;
    for (int y = inset.y; y < inset.y + inset.size; ++y) {
        const auto begin =
            frame.frame.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * frame.width + inset.x);
        rgb.insert(rgb.end(), begin, begin + 3 * static_cast<std::ptrdiff_t>(inset.size));
    }
    return rgb;
}

}  // namespace penumbra::report
