// SPDX-License-Identifier: MIT
// Separable filters of planes, for SSIM and FLIP. Sums run in the order of the taps, so that the
// same plane gives the same bytes everywhere.
#pragma once
#include <vector>

namespace penumbra::metrics {

/// What lies beyond the edges of a plane.
enum class Border {
    replicate,   ///< the nearest pixel of the plane
    renormalise  ///< nothing: the taps inside are scaled to the sum of all of them
};

using Plane = std::vector<float>;  ///< [height, width], row by row

/// A filter along one axis: an odd number of taps, the middle one at the pixel itself.
/// Correlation: tap i meets the pixel at i - radius.
using Taps = std::vector<float>;

/// A Gaussian of standard deviation `sigma` pixels, 2 * radius + 1 taps that sum to 1.
std::vector<double> gaussianTaps(double sigma, int radius);

/// Filters the rows, then the columns of `source`, which has `width` columns. `target` gets the
/// same size and is another plane. `Border::renormalise` needs taps that sum to more than 0.
/// `scratch` is memory that calls may share.
void filterRows(const Plane& source, int width, const Taps& taps, Border border, Plane& target);
void filterColumns(const Plane& source, int width, const Taps& taps, Border border, Plane& target);
void filterSeparable(const Plane& source, int width, const Taps& rows, const Taps& columns,
                     Border border, Plane& scratch, Plane& target);

}  // namespace penumbra::metrics
