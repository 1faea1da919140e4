// SPDX-License-Identifier: MIT
// The nearest triangle of each pixel, with 32-bit atomics, against its double-precision twin.
#include <gtest/gtest.h>

#include "tests/reference/gbuffer_raster_checks.h"

namespace penumbra::tests {
namespace {

constexpr auto kPath = RasterPath::atomics32;

TEST(GBufferRaster, TheNearestOfOverlappingTrianglesIsKeptWithItsDepth) {
    expectOverlappingTrianglesSorted(kPath);
}

TEST(GBufferRaster, TrianglesThatReachBehindTheEyeAreCutAtTheNearPlane) {
    expectTrianglesCutByTheNearPlane(kPath);
}

TEST(GBufferRaster, TextureFactorAndVertexColourDecideWhatAnAlphaTestKeeps) {
    expectAlphaDecidesFragments(kPath);
}

TEST(GBufferRaster, MaskKeepsItsCutoffAndBlendIsOpaqueFromOne) {
    expectThresholdsAreKeptExactly(kPath);
}

TEST(GBufferRaster, TrianglesOfEqualDepthGoToTheLowestIndex) {
    expectTiesGoToTheLowestIndex(kPath);
}

TEST(GBufferRaster, BackFacesOfSingleSidedMaterialsAreDroppedAlsoWhereNodesMirror) {
    expectBackFacesAreDropped(kPath);
}

}  // namespace
}  // namespace penumbra::tests
