// SPDX-License-Identifier: MIT
// Twin of kernels/shading/temporal.cl in double: no history is copied from frame to frame; a
// pixel's surface is followed back through the frames that are kept whole.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/camera.h"

namespace penumbra::tests {

/// What one frame knew of each entry of the G-buffer: pixels, then blended fragments.
struct TemporalFrame {
    int width = 0, height = 0;
    std::vector<std::vector<std::size_t>> lists;  ///< [pixel] entries of its fragments
    std::vector<std::size_t> owner;               ///< [entry] pixel
    scene::CameraFrame camera;
    std::vector<std::uint32_t> object;
    std::vector<double> depth;         ///< camera depth, metres
    std::vector<glm::dvec3> previous;  ///< where the surface was in the frame before
    std::vector<bool> tested;          ///< whether shadow tests were made at all
    std::vector<glm::dvec3> visibility;
};

struct TemporalMean {
    glm::dvec3 visibility{0};
    int frames = 1;         ///< that the mean is of
    bool doubtful = false;  ///< a step lies so near to a limit that float may decide otherwise
};

/// Mean of an entry of the last frame over at most `window` frames, earlier ones clamped to what
/// the last frame holds among the pixel's 3 x 3 neighbours; of a fragment, of the same surface
/// there.
TemporalMean temporalMean(const std::vector<TemporalFrame>& frames, int window, std::size_t entry);

}  // namespace penumbra::tests
