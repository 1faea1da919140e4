// SPDX-License-Identifier: MIT
// From the device's planes to a Frame: supersampled pixels are averaged, or picked where an average
// has no meaning (depth, normals, positions, ids: the sample nearest to the pixel's centre).
#pragma once
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "host/penumbra.h"
#include "host/visibility/technique.h"

namespace penumbra {
struct AovChoice;
}

namespace penumbra::image {

struct FramePlanes {
    int width = 0, height = 0, supersample = 1;
    int stride = 0;              ///< floats between planes; rows have width * supersample pixels
    std::vector<float> colour;   ///< [3, stride]
    std::vector<float> gbuffer;  ///< [GB_PLANES, stride], or empty
    std::vector<float> objects;  ///< [stride], where gbuffer is empty
    std::vector<float> alpha;    ///< [pixel] coverage; empty: 1 where there is an object
    /// [pixel] the entry of the planes beside colour that a pixel shows; empty: its own
    std::vector<std::uint32_t> front;
};

Frame assembleFrame(const FramePlanes& planes, const AovChoice& aovs, const glm::dvec3& centre);
/// Adds visibility.<light>.R, .G, .B; one channel of visibility is written three times.
void addVisibility(const FramePlanes& planes, const std::string& light,
                   const std::vector<float>& visibility, Frame& frame);
void addMasks(const FramePlanes& planes, const std::string& light,
              const visibility::OcclusionMasks& masks, Frame& frame);
void addDepthMaps(const std::string& light, const visibility::DepthMaps& maps, Frame& frame);

}  // namespace penumbra::image
