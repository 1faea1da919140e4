// SPDX-License-Identifier: MIT
#include "tests/reference/raster4d_ref.h"

#include <algorithm>

#include "kernels/shared/gbuffer.h"

namespace penumbra::tests {

bool maskBit(const ShadowRun& run, std::size_t pixel, int row, int column) {
    const auto& masks = run.masks;
    const auto plane = static_cast<std::size_t>(row * masks.words() + column / 32);
    return masks.bits[plane * masks.stride + pixel] >> (column % 32) & 1U;
}

MaskAgreement compareMasks(const ShadowRun& run, std::size_t pixelStep) {
    MaskAgreement result;
    const double tolerance = 1e-6 * std::max(run.bounds.empty ? 0 : run.bounds.radius(), 1e-30);
    const auto points = run.samplePoints();
    for (std::size_t i = 0; i < run.pixels(); i += pixelStep) {
        if (!run.tested(i)) continue;
        const glm::dvec3 origin = run.shadowOrigin(i), normal = run.vectorAt(GB_GEOMETRIC, i);
        for (int row = 0; row < run.masks.rows; ++row)
            for (int column = 0; column < run.masks.columns; ++column) {
                const int sample =
                    run.masks.samples[static_cast<std::size_t>(row * run.masks.columns + column)];
                if (sample < 0) continue;
                const glm::dvec3 point = points[static_cast<std::size_t>(sample)];
                const double height = glm::dot(point - origin, normal);
                Verdict verdict = Verdict::hidden;
                if (height > -tolerance)
                    verdict = segmentVerdict(run.casters, origin, point, tolerance);
                if (std::abs(height) <= tolerance && verdict == Verdict::open)
                    verdict = Verdict::graze;
                const bool hidden = maskBit(run, i, row, column);
                ++result.bits;
                result.hidden += hidden;
                result.grazes += verdict == Verdict::graze;
                result.wrong += verdict != Verdict::graze && hidden != (verdict == Verdict::hidden);
            }
    }
    return result;
}

}  // namespace penumbra::tests
