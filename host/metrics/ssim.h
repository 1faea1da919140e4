// SPDX-License-Identifier: MIT
// Structural similarity of two pictures.
#pragma once
#include "host/metrics/picture.h"

namespace penumbra::metrics {

/// SSIM for a range of values of 1: Gaussian windows of 11x11 pixels with a standard deviation of
/// 1.5, K1 = 0.01, K2 = 0.03. The map is in [-1, 1], 1 where the windows are equal; symmetric.
/// Pictures of three planes are compared by 0.2126 R + 0.7152 G + 0.0722 B of the values as they
/// are: encoded for sRGB, linear for visibility. NaN and infinities: comparableValue().
/// mask  empty, or true where a pixel's window counts; windows also see pixels that do not count.
///       Where no pixel counts the mean is 1.
/// Throws Error where requireComparable() does.
/// Source: [SSIM] Wang, Bovik, Sheikh, Simoncelli: Image Quality Assessment: From Error Visibility
/// to Structural Similarity, IEEE TIP 13(4), 2004, eqs. 13 to 17. Differs: they take only windows
/// that lie wholly inside; here a window that reaches over the edge is cut there and its weights
/// are scaled to 1, so that each pixel has a value and the smallest picture is 1x1.
MetricMap ssim(const Picture& a, const Picture& b, const std::vector<bool>& mask = {});

}  // namespace penumbra::metrics
