// SPDX-License-Identifier: MIT
// Runs geometry and G-buffer for a scene at rest and brings the planes to the host.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace penumbra::tests {

/// A blended fragment of the A-buffer.
struct ListedFragment {
    int triangle = -1;
    float depth = 0;        ///< as shared/raster.h
    std::size_t entry = 0;  ///< pixel of the G-buffer that describes it
    double alpha = 0;
    glm::dvec3 through{0};
};

struct GBufferRun {
    int width = 0, height = 0;
    std::size_t stride = 0;
    std::vector<float> planes;  ///< [GB_PLANES, stride]
    std::uint32_t nonFinite = 0;
    std::vector<std::vector<ListedFragment>> lists;  ///< per pixel; empty: nothing is blended
    std::uint32_t layers = 0;                        ///< of the longest list
    int repetitions = 0;                             ///< until all lists were long enough
    std::size_t at(int x, int y) const { return static_cast<std::size_t>(y * width + x); }
    float value(int plane, int x, int y) const {
        return planes[static_cast<std::size_t>(plane) * stride + at(x, y)];
    }
    glm::dvec3 vector(int plane, int x, int y) const {
        return {value(plane, x, y), value(plane + 1, x, y), value(plane + 2, x, y)};
    }
    std::uint32_t object(int x, int y) const;  ///< node + 1; 0: background
};

GBufferRun runGBuffer(const scene::Scene& scene, const scene::CameraFrame& camera, int width,
                      int height, const glm::dvec3& centre = glm::dvec3(0), bool atomics64 = true);

/// Orthographic camera at z = 10 whose pixel (column, row) is the point (column, -row) of the plane
/// z = 0.
scene::CameraFrame pixelCamera(int width, int height);

/// A perspective camera at `eye` that looks at `target`.
scene::CameraFrame perspectiveCamera(const glm::dvec3& eye, const glm::dvec3& target,
                                     double yfovDegrees);

/// Direction of the ray through the centre of a pixel; its component along the view is 1.
glm::dvec3 pixelRay(const scene::CameraFrame& camera, int width, int height, int x, int y);

}  // namespace penumbra::tests
