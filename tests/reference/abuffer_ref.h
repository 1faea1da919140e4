// SPDX-License-Identifier: MIT
// Twin of kernels/gbuffer/abuffer.cl in double: all surfaces that a pixel's line of sight meets, of
// which those that are blended and not behind an opaque one make the list. Coverage and depth are
// those of gbuffer_raster_ref.h, alpha and what passes those of gbuffer_resolve_ref.h.
#pragma once
#include <vector>

#include "tests/reference/gbuffer_raster_ref.h"
#include "tests/reference/gbuffer_resolve_ref.h"

namespace penumbra::tests {

/// A blended fragment; fields of RasterFragment, and `doubtful` also where snapping may put it
/// behind the opaque surface.
struct BlendedFragment : RasterFragment {
    double alpha = 1;
    glm::dvec3 through{0};
};

class ABufferReference {
  public:
    ABufferReference(const scene::Scene& scene, const scene::CameraFrame& camera, int width,
                     int height);
    /// From the nearest to the farthest.
    std::vector<BlendedFragment> list(int column, int row) const;

  private:
    const scene::Material& materialOf(int triangle) const;

    std::vector<FlatTriangle> triangles_;
    RasterReference raster_;
    ResolveReference surfaces_;
};

}  // namespace penumbra::tests
