// SPDX-License-Identifier: MIT
#include "host/metrics/image_error.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "host/metrics/ssim.h"
#include "runtime/error.h"

namespace penumbra::metrics {
namespace {

double difference(float a, float b) {
    if (a == b) return 0;
    if (!std::isfinite(a) || !std::isfinite(b)) return 1;
    return std::abs(static_cast<double>(a) - b);
}

/// "visibility.key.R" -> "visibility.key"; "R" -> "RGB"; "A" and "Z" stand alone.
std::string layerOf(const std::string& channel) {
    if (channel == "R" || channel == "G" || channel == "B") return "RGB";
    const auto dot = channel.rfind('.');
    return dot == std::string::npos ? channel : channel.substr(0, dot);
}

using Planes = std::vector<const std::vector<float>*>;

Planes planesOf(const image::LoadedImage& image, const std::string& layer) {
    Planes planes;
    for (const auto& channel : image.channels)
        if (layerOf(channel.name) == layer) planes.push_back(&channel.values);
    return planes;
}

std::vector<std::string> layersOf(const image::LoadedImage& image) {
    std::set<std::string> layers;
    for (const auto& channel : image.channels) layers.insert(layerOf(channel.name));
    return {layers.begin(), layers.end()};
}

/// The mask for visibility: background is left out where both images tell it by their alpha.
std::vector<bool> withoutBackground(const image::LoadedImage& a, const image::LoadedImage& b,
                                    std::vector<bool> mask) {
    const auto *alphaA = a.find("A"), *alphaB = b.find("A");
    if (!alphaA || !alphaB) return mask;
    if (mask.empty()) mask.assign(alphaA->size(), true);
    for (std::size_t i = 0; i < mask.size(); ++i)
        mask[i] = mask[i] && ((*alphaA)[i] > 0 || (*alphaB)[i] > 0);
    return mask;
}

std::vector<std::string> chooseLayers(const image::LoadedImage& a, const image::LoadedImage& b,
                                      const std::string& layer) {
    const auto inA = layersOf(a), inB = layersOf(b);
    std::vector<std::string> common;
    std::set_intersection(inA.begin(), inA.end(), inB.begin(), inB.end(),
                          std::back_inserter(common));
    if (!layer.empty()) {
        require(std::find(common.begin(), common.end(), layer) != common.end(),
                "layer '{}' is not in both images; both have: {}", layer, fmt::join(common, ", "));
        return {layer};
    }
    std::vector<std::string> chosen;
    for (const auto& name : common)
        if (name.rfind("visibility.", 0) == 0) chosen.push_back(name);
    if (!chosen.empty()) return chosen;
    require(std::find(common.begin(), common.end(), "RGB") != common.end(),
            "the images share neither visibility.* nor R, G, B; both have: {}",
            fmt::join(common, ", "));
    return {"RGB"};
}

/// Fills in what is measured of the layer as a picture.
void addPerceived(const image::LoadedImage& a, const image::LoadedImage& b,
                  const std::vector<bool>& mask, const FlipSettings& settings, LayerError& error) {
    const float gain = commonGain(a, b);
    const auto inA = pictureOf(a, error.layer, gain), inB = pictureOf(b, error.layer, gain);
    if (!inA || !inB) return;
    error.ssim = ssim(*inA, *inB, mask).mean;
    error.flip = flip(*inA, *inB, mask, settings).mean;
}

/// The mean of a figure of all layers, if all of them have it.
std::optional<double> meanOf(const std::vector<LayerError>& errors,
                             std::optional<double> LayerError::*figure) {
    double sum = 0;
    for (const auto& error : errors) {
        if (!(error.*figure)) return std::nullopt;
        sum += *(error.*figure);
    }
    return sum / static_cast<double>(errors.size());
}

}  // namespace

ImageError imageError(const Planes& a, const Planes& b, const std::vector<bool>& mask) {
    ImageError result;
    double squares = 0, sum = 0;
    std::size_t beyond[3] = {0, 0, 0};
    const std::size_t count = a.empty() ? 0 : a[0]->size();
    for (std::size_t i = 0; i < count; ++i) {
        if (!mask.empty() && !mask[i]) continue;
        ++result.pixels;
        double worst = 0;
        for (std::size_t p = 0; p < a.size(); ++p) {
            const double d = difference((*a[p])[i], (*b[p])[i]);
            squares += d * d;
            sum += d;
            worst = std::max(worst, d);
        }
        result.maximum = std::max(result.maximum, worst);
        const double steps[3] = {1, 4, 16};
        for (int s = 0; s < 3; ++s) beyond[s] += worst > steps[s] / 255 ? 1 : 0;
    }
    const double samples = static_cast<double>(result.pixels * a.size());
    if (samples == 0) return result;
    result.rmse = std::sqrt(squares / samples);
    result.mean = sum / samples;
    result.psnr =
        squares > 0 ? -10 * std::log10(squares / samples) : std::numeric_limits<double>::infinity();
    for (std::size_t s = 0; s < 3; ++s)
        result.share[s] = static_cast<double>(beyond[s]) / static_cast<double>(result.pixels);
    return result;
}

std::vector<LayerError> compareImages(const image::LoadedImage& a, const image::LoadedImage& b,
                                      const std::string& layer, const std::vector<bool>& mask,
                                      const FlipSettings& flipSettings) {
    require(a.width == b.width && a.height == b.height,
            "the images have {}x{} and {}x{} pixels; they must agree", a.width, a.height, b.width,
            b.height);
    require(mask.empty() || mask.size() == static_cast<std::size_t>(a.width) *
                                               static_cast<std::size_t>(a.height),
            "the mask has not the images' {}x{} pixels", a.width, a.height);
    std::vector<LayerError> errors;
    Planes allA, allB;
    const auto layers = chooseLayers(a, b, layer);
    const bool visibility = layers[0].rfind("visibility.", 0) == 0;
    const auto counted = visibility ? withoutBackground(a, b, mask) : mask;
    for (const auto& name : layers) {
        const auto pa = planesOf(a, name), pb = planesOf(b, name);
        require(pa.size() == pb.size(), "layer '{}' has {} and {} channels", name, pa.size(),
                pb.size());
        errors.push_back({name, imageError(pa, pb, counted), {}, {}});
        addPerceived(a, b, counted, flipSettings, errors.back());
        allA.insert(allA.end(), pa.begin(), pa.end());
        allB.insert(allB.end(), pb.begin(), pb.end());
    }
    const std::string whole = layers.size() == 1 ? layers[0] : "visibility";
    errors.insert(errors.begin(),
                  {whole, imageError(allA, allB, counted), meanOf(errors, &LayerError::ssim),
                   meanOf(errors, &LayerError::flip)});
    return errors;
}

}  // namespace penumbra::metrics
