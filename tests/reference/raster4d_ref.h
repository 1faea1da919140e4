// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/raster4d.cl: every triangle for every segment, in double, in the
// world's own coordinates; no grid, no sorting, no rows.
#pragma once
#include "tests/reference/segment_verdict.h"
#include "tests/reference/shadow_run.h"

namespace penumbra::tests {

/// Bit of a pixel and a light sample; cells without a sample are not hidden.
bool maskBit(const ShadowRun& run, std::size_t pixel, int row, int column);

/// How masks compare with the twin.
struct MaskAgreement {
    std::size_t bits = 0, hidden = 0, grazes = 0, wrong = 0;
};
MaskAgreement compareMasks(const ShadowRun& run, std::size_t pixelStep = 1);

}  // namespace penumbra::tests
