// SPDX-License-Identifier: MIT
// Twin of kernels/gbuffer/gbuffer_raster.cl and gbuffer_raster64.cl: all triangles that a pixel
// sees, in double. Coverage is that of raster_ref.h; depth and alpha are taken where the line of
// sight through the pixel's centre meets the triangle's plane.
#pragma once
#include <memory>
#include <vector>

#include "tests/reference/flat_scene.h"
#include "tests/reference/texture_ref.h"

namespace penumbra::tests {

/// A surface at the centre of a pixel.
struct RasterFragment {
    int triangle = -1;
    double depth = 0;       ///< as shared/raster.h: 1 at the near plane, falls with distance
    double slack = 0;       ///< by how much snapping to 1/256 pixel may change depth
    bool doubtful = false;  ///< alpha lies so near to its threshold that float may decide otherwise
};

class RasterReference {
  public:
    RasterReference(const scene::Scene& scene, const scene::CameraFrame& camera, int width,
                    int height);
    /// Fragments that cover the pixel and face the camera.
    std::vector<RasterFragment> covering(int column, int row) const;
    /// Those of them that are opaque: they pass their alpha test, or may pass it; BLEND has an
    /// alpha of 1.
    std::vector<RasterFragment> fragments(int column, int row) const;

  private:
    struct Screen {
        std::vector<glm::dvec2> pixel;  ///< corners after clipping to the near plane
        double depthLow = 0, depthHigh = 0;
        double relativeSlack = 0;  ///< of the depth range
        bool faces = false;
    };
    Screen project(const FlatTriangle& triangle) const;
    double depthOf(double metres) const;
    /// Factor x texture level 0 x vertex colour.
    double alphaOf(const FlatTriangle& triangle, const PlaneHit& hit) const;

    scene::CameraFrame camera_;
    int width_, height_;
    std::vector<FlatTriangle> triangles_;
    std::vector<Screen> screens_;
    std::vector<std::unique_ptr<TextureReference>> colourTextures_;  ///< [triangle]
};

}  // namespace penumbra::tests
