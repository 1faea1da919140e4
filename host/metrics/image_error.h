// SPDX-License-Identifier: MIT
// How far two images are apart.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/image/image_file.h"
#include "host/metrics/flip.h"

namespace penumbra::metrics {

/// Over all samples of all planes compared; values as stored (linear for EXR, 0 to 1 for PNG).
struct ImageError {
    std::size_t pixels = 0;
    double rmse = 0, maximum = 0, mean = 0;  ///< of absolute differences
    double psnr = 0;                         ///< dB for a peak of 1; infinite for equal images
    std::array<double, 3> share{};           ///< of pixels that differ by more than 1, 4, 16 of 255
};

/// Planes have equal lengths. `mask` is empty or holds true where a pixel counts. Values that are
/// not finite differ from all but themselves and count as a difference of 1.
ImageError imageError(const std::vector<const std::vector<float>*>& a,
                      const std::vector<const std::vector<float>*>& b,
                      const std::vector<bool>& mask);

struct LayerError {
    std::string layer;
    ImageError error;
    /// Means of ssim() and flip() of what pictureOf() makes of the layer; of several layers their
    /// mean; none where a layer is no picture.
    std::optional<double> ssim, flip;
};

/// Compares the layers that both images have: every visibility.* if any is in both, else RGB; or
/// `layer`. Visibility leaves out background (alpha 0 in both). The first entry is over all of
/// them. Throws Error where sizes differ or nothing can be compared.
std::vector<LayerError> compareImages(const image::LoadedImage& a, const image::LoadedImage& b,
                                      const std::string& layer, const std::vector<bool>& mask,
                                      const FlipSettings& flipSettings = {});

}  // namespace penumbra::metrics
