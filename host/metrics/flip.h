// SPDX-License-Identifier: MIT
// LDR-FLIP: the difference that a person sees who alternates between two pictures.
#pragma once
#include "host/metrics/picture.h"

namespace penumbra::metrics {

struct FlipSettings {
    /// Of the screen as seen, 1 to 1000. 67: a screen 0.7 m wide with 3840 pixels, 0.7 m away.
    double pixelsPerDegree = 67;
};

/// FLIP of each pixel, in [0, 1]: 0 where nothing is seen, 1 for the largest difference; and its
/// mean. Symmetric up to rounding. sRGB pictures are taken as they are; linear ones (visibility,
/// albedo) as if they had been encoded to sRGB for the screen; one plane is grey. NaN and
/// infinities: comparableValue(). Beyond its edges a picture goes on as its outermost pixels.
/// mask  empty, or true where a pixel counts in the mean; filters also see pixels that do not
///       count. Where no pixel counts the mean is 0.
/// Throws Error where requireComparable() does, or for settings outside their range.
/// Source: [FLIP] Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astrom, Fairchild: FLIP: A
/// Difference Evaluator for Alternating Images, Proc. ACM Comput. Graph. Interact. Tech. 3(2)
/// (HPG), 2020, section 4; filters run along rows and columns in float.
MetricMap flip(const Picture& reference, const Picture& test, const std::vector<bool>& mask = {},
               const FlipSettings& settings = {});

}  // namespace penumbra::metrics
