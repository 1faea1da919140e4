// SPDX-License-Identifier: MIT
#include "host/metrics/picture.h"

#include <algorithm>
#include <cmath>

#include "host/image/srgb.h"
#include "host/image/tone_map.h"
#include "runtime/error.h"

namespace penumbra::metrics {
namespace {

std::optional<float> gainOf(const image::LoadedImage& image) {
    for (const auto& [key, value] : image.header) {
        if (key != "penumbra.gain") continue;
        try {
            const float gain = std::stof(value);
            if (gain > 0 && std::isfinite(gain)) return gain;
        } catch (const std::exception&) {
        }
        throw Error(fmt::format("header penumbra.gain is '{}'; a number above 0 is needed", value));
    }
    return std::nullopt;
}

void toneMapPlanes(std::vector<Plane>& rgb, const Plane* alpha, float gain) {
    for (std::size_t i = 0; i < rgb[0].size(); ++i) {
        float pixel[3] = {rgb[0][i], rgb[1][i], rgb[2][i]};
        image::toneMapPixel(pixel, alpha ? (*alpha)[i] : 1.0F, gain);
        for (std::size_t c = 0; c < 3; ++c) rgb[c][i] = image::srgbFromLinear(pixel[c]);
    }
}

}  // namespace

float comparableValue(float value, float other) {
    if (!std::isnan(value)) return std::clamp(value, 0.0F, 1.0F);
    return other < 0.5F ? 1.0F : 0.0F;  // 0 for two NaNs
}

void requireComparable(const Picture& a, const Picture& b, const std::vector<bool>& mask) {
    require(a.width > 0 && a.height > 0 && a.width == b.width && a.height == b.height,
            "the pictures have {}x{} and {}x{} pixels; they must agree", a.width, a.height, b.width,
            b.height);
    require(a.encoding == b.encoding, "one picture is sRGB-encoded, the other is linear");
    const auto pixels = static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height);
    for (const auto* picture : {&a, &b}) {
        require(picture->planes.size() == a.planes.size() &&
                    (a.planes.size() == 1 || a.planes.size() == 3),
                "the pictures have {} and {} planes; 1 or 3 in both are needed", a.planes.size(),
                b.planes.size());
        for (const auto& plane : picture->planes)
            require(plane.size() == pixels, "a plane has {} values for {}x{} pixels", plane.size(),
                    a.width, a.height);
    }
    require(mask.empty() || mask.size() == pixels, "the mask has {} values for {}x{} pixels",
            mask.size(), a.width, a.height);
}

double maskedMean(const Plane& map, const std::vector<bool>& mask, double fallback) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (!mask.empty() && !mask[i]) continue;
        sum += static_cast<double>(map[i]);
        ++count;
    }
    return count ? sum / static_cast<double>(count) : fallback;
}

std::optional<Picture> pictureOf(const image::LoadedImage& image, const std::string& layer,
                                 float gain) {
    const bool colour = layer == "RGB";
    if (!colour && layer != "albedo" && layer.rfind("visibility.", 0) != 0) return std::nullopt;
    Picture picture{image.width, image.height, Encoding::linear, {}};
    for (const char* channel : {"R", "G", "B"})
        if (const auto* plane = image.find(colour ? channel : layer + "." + channel))
            picture.planes.push_back(*plane);
    if (picture.planes.size() != 1 && picture.planes.size() != 3) return std::nullopt;
    if (!colour) return picture;
    picture.encoding = Encoding::srgb;
    if (image.srgb) return picture;
    picture.planes.resize(3, picture.planes[0]);  // a file with R alone is grey
    toneMapPlanes(picture.planes, image.find("A"), gain);
    return picture;
}

float commonGain(const image::LoadedImage& a, const image::LoadedImage& b) {
    const auto gain = gainOf(a);
    return gain ? *gain : gainOf(b).value_or(1.0F);
}

}  // namespace penumbra::metrics
