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

/// Entries of a pixel that an entry may be compared with: fragments with fragments.
std::vector<std::size_t> candidates(const TemporalFrame& frame, std::size_t pixel, bool blended) {
    return blended ? frame.lists[pixel] : std::vector<std::size_t>{pixel};
}

bool isBlended(const TemporalFrame& frame, std::size_t entry) {
    return entry >= static_cast<std::size_t>(frame.width * frame.height);
}

/// By how much of its depth `at` an entry is off; of another object: infinitely.
double offBy(const TemporalFrame& frame, std::size_t entry, std::uint32_t object, double at) {
    return frame.object[entry] == object ? std::abs(frame.depth[entry] - at) / std::abs(at) : 1e300;
}

/// Entry of the frame before that was an entry's surface; -1: none was.
int stepBack(const TemporalFrame& now, const TemporalFrame& before, std::size_t entry,
             bool& doubtful) {
    const glm::dvec3 at = seenFrom(before, now.previous[entry]);
    if (!before.camera.orthographic && at.z <= 0) return -1;
    doubtful |= nearInteger(at.x) || nearInteger(at.y);
    if (at.x < 0 || at.y < 0 || at.x >= before.width || at.y >= before.height) return -1;
    const auto last = static_cast<std::size_t>(at.y) * static_cast<std::size_t>(before.width) +
                      static_cast<std::size_t>(at.x);
    // A surface that was there is the same if its depth agrees to 1 %
    int best = -1;
    double least = 0.01;
    for (const auto other : candidates(before, last, isBlended(now, entry))) {
        const double off = offBy(before, other, now.object[entry], at.z);
        doubtful |= std::abs(off - 0.01) < 1e-4 || (best >= 0 && std::abs(off - least) < 1e-5);
        if (off >= least) continue;
        best = static_cast<int>(other);
        least = off;
    }
    return best;
}

/// Visibility of the frame around an entry, 3 x 3 pixels, where it was tested.
void neighbourhood(const TemporalFrame& frame, std::size_t entry, glm::dvec3& low, glm::dvec3& high,
                   bool& doubtful) {
    const bool blended = isBlended(frame, entry);
    const int pixel = static_cast<int>(frame.owner[entry]);
    const int x = pixel % frame.width, y = pixel / frame.width;
    low = high = frame.visibility[entry];
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= frame.width || y + dy >= frame.height)
                continue;
            const auto at = static_cast<std::size_t>((y + dy) * frame.width + x + dx);
            for (const auto other : candidates(frame, at, blended)) {
                const double off = offBy(frame, other, frame.object[entry], frame.depth[entry]);
                doubtful |= blended && std::abs(off - 0.01) < 1e-6;
                if ((blended && off >= 0.01) || !frame.tested[other]) continue;
                low = glm::min(low, frame.visibility[other]);
                high = glm::max(high, frame.visibility[other]);
            }
        }
}

}  // namespace

TemporalMean temporalMean(const std::vector<TemporalFrame>& frames, int window, std::size_t entry) {
    TemporalMean mean;
    std::size_t frame = frames.size() - 1;
    mean.visibility = frames[frame].visibility[entry];
    glm::dvec3 low, high;
    neighbourhood(frames[frame], entry, low, high, mean.doubtful);
    while (mean.frames < window && frame > 0 && frames[frame].tested[entry]) {
        const int last = stepBack(frames[frame], frames[frame - 1], entry, mean.doubtful);
        if (last < 0) break;
        --frame;
        entry = static_cast<std::size_t>(last);
        if (!frames[frame].tested[entry]) break;
        mean.visibility += glm::clamp(frames[frame].visibility[entry], low, high);
        ++mean.frames;
    }
    mean.visibility /= static_cast<double>(mean.frames);
    return mean;
}

}  // namespace penumbra::tests
