// SPDX-License-Identifier: MIT
// Runs the rasteriser's kernels alone and compares them with gbuffer_raster_ref.h; shared by the
// tests of the path with 32-bit and of that with 64-bit atomics.
#pragma once
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/reference/gbuffer_raster_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {

/// What the kernels leave per pixel.
struct RasterImage {
    int width = 0, height = 0;
    std::vector<float> depths;
    std::vector<int> triangles;  ///< -1: none
};

enum class RasterPath { atomics32, atomics64 };
RasterImage rasterise(RasterPath path, const scene::Scene& scene, const scene::CameraFrame& camera,
                      int width, int height);

/// How an image differs from the twin.
struct RasterDifference {
    int wrong = 0;    ///< pixels whose triangle cannot be the nearest, whatever snapping does
    int decided = 0;  ///< pixels where snapping, or an alpha at its threshold, chose another one
    int covered = 0;  ///< by any triangle, according to the twin
};
RasterDifference compareRaster(const RasterImage& image, const RasterReference& twin);

/// What the camera meets in the tests; each has `count` triangles of a node each.
SceneBuilder overlappingTriangles(unsigned seed, int count);  ///< small and large, both sides
SceneBuilder surroundingTriangles(unsigned seed, int count);  ///< also behind the eye
SceneBuilder texturedTriangles(unsigned seed, int count, scene::AlphaMode mode);
/// Orthographic view of triangles at `layers` depths; coordinates are multiples of 1/64 pixel and
/// depths exact in float, so that nothing is rounded.
SceneBuilder exactTriangles(unsigned seed, int count, int layers, glm::dvec2 extent);

/// The checks themselves, so that both paths pass the same ones.
void expectOverlappingTrianglesSorted(RasterPath path);
void expectTrianglesCutByTheNearPlane(RasterPath path);
void expectAlphaDecidesFragments(RasterPath path);
void expectThresholdsAreKeptExactly(RasterPath path);
void expectTiesGoToTheLowestIndex(RasterPath path);
void expectBackFacesAreDropped(RasterPath path);

}  // namespace penumbra::tests
