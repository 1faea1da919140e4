// SPDX-License-Identifier: MIT
// What SSIM and FLIP look at: a layer of an image file, made ready for the eye.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/image/image_file.h"
#include "host/metrics/separable.h"

namespace penumbra::metrics {

enum class Encoding { srgb, linear };

/// Values in [0, 1]; what lies outside counts as the nearer end.
struct Picture {
    int width = 0, height = 0;  ///< pixels
    Encoding encoding = Encoding::srgb;
    std::vector<Plane> planes;  ///< 3: R, G, B; 1: grey; each [height, width]
};

/// A metric of two pictures, pixel by pixel.
struct MetricMap {
    double mean = 0;  ///< over the pixels that count
    Plane map;        ///< [height, width], pixels that do not count included
};

/// The value that stands for `value` in a comparison with `other`: in [0, 1], infinities clamped. A
/// NaN that only one of them has counts as the end of the range that is farther from the other, so
/// that it never passes for agreement; two NaNs agree.
float comparableValue(float value, float other);

/// Throws Error unless both pictures have the same size and encoding, 1 or 3 planes each of that
/// size, and `mask` is empty or has as many pixels.
void requireComparable(const Picture& a, const Picture& b, const std::vector<bool>& mask);

/// Mean of `map` over the pixels that count; `fallback` where none does.
double maskedMean(const Plane& map, const std::vector<bool>& mask, double fallback);

/// The layer of an image as a picture, or nothing for layers that are none (depth, normals, ids):
/// RGB      as stored where it is sRGB; else with `gain`, tone-mapped and encoded as PNG files are
/// albedo   linear, as stored
/// visibility.*  linear, as stored; 1 or 3 planes
std::optional<Picture> pictureOf(const image::LoadedImage& image, const std::string& layer,
                                 float gain);

/// The gain of the frame in `a`, else in `b`: header penumbra.gain, which the renderer writes and
/// PNG files were made with; else 1. Both images get the same, so that none hides a difference in
/// brightness.
float commonGain(const image::LoadedImage& a, const image::LoadedImage& b);

}  // namespace penumbra::metrics
