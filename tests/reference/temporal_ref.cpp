// SPDX-License-Identifier: MIT
#include "tests/reference/temporal_ref.h"

#include <cmath>

namespace penumbra::tests {
namespace {

/// Image position (pixels) and camera depth (metres) of a point.
glm::dvec3 seenFrom(const TemporalFrame& frame, const glm::dvec3& point) {
    const auto& camera = frame.camera;
    const glm::dvec3 local(glm::inverse(camera.worldFromCamera) * glm::dvec4(point, 1));
    glm::dvec2 half(camera.xmag, camera.ymag);
    if (!camera.orthographic) {
        const double t = -local.z * std::tan(camera.yfovRad / 2);
        half = {t * frame.width / frame.height, t};
    }
    return {0.5 * frame.width * (1 + local.x / half.x), 0.5 * frame.height * (1 - local.y / half.y),
            -local.z};
}

bool nearInteger(double x) {
    return std::abs(x - std::round(x)) < 1e-3;
}

/// Pixel of the frame before that saw a pixel's surface; -1: none did.
int stepBack(const TemporalFrame& now, const TemporalFrame& before, std::size_t pixel,
             bool& doubtful) {
    const glm::dvec3 at = seenFrom(before, now.previous[pixel]);
    if (!before.camera.orthographic && at.z <= 0) return -1;
    doubtful |= nearInteger(at.x) || nearInteger(at.y);
    if (at.x < 0 || at.y < 0 || at.x >= before.width || at.y >= before.height) return -1;
    const auto last = static_cast<std::size_t>(at.y) * static_cast<std::size_t>(before.width) +
                      static_cast<std::size_t>(at.x);
    if (before.object[last] != now.object[pixel]) return -1;
    // The surface that was there is the same if its depth agrees to 1 %
    const double off = std::abs(before.depth[last] - at.z) / std::abs(at.z);
    doubtful |= std::abs(off - 0.01) < 1e-4;
    return off < 0.01 ? static_cast<int>(last) : -1;
}

/// Visibility of the frame around a pixel, 3 x 3, where it was tested.
void neighbourhood(const TemporalFrame& frame, std::size_t pixel, glm::dvec3& low,
                   glm::dvec3& high) {
    const int x = static_cast<int>(pixel) % frame.width, y = static_cast<int>(pixel) / frame.width;
    low = high = frame.visibility[pixel];
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= frame.width || y + dy >= frame.height)
                continue;
            const auto at = static_cast<std::size_t>((y + dy) * frame.width + x + dx);
            if (!frame.tested[at]) continue;
            low = glm::min(low, frame.visibility[at]);
            high = glm::max(high, frame.visibility[at]);
        }
}

}  // namespace

TemporalMean temporalMean(const std::vector<TemporalFrame>& frames, int window, std::size_t pixel) {
    TemporalMean mean;
    std::size_t frame = frames.size() - 1;
    mean.visibility = frames[frame].visibility[pixel];
    glm::dvec3 low, high;
    neighbourhood(frames[frame], pixel, low, high);
    while (mean.frames < window && frame > 0 && frames[frame].tested[pixel]) {
        const int last = stepBack(frames[frame], frames[frame - 1], pixel, mean.doubtful);
        if (last < 0) break;
        --frame;
        pixel = static_cast<std::size_t>(last);
        if (!frames[frame].tested[pixel]) break;
        mean.visibility += glm::clamp(frames[frame].visibility[pixel], low, high);
        ++mean.frames;
    }
    mean.visibility /= static_cast<double>(mean.frames);
    return mean;
}

}  // namespace penumbra::tests
