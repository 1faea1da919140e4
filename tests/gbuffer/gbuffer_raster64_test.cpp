// SPDX-License-Identifier: MIT
// The nearest triangle of each pixel, with 64-bit atomics, against its double-precision twin.
#include "tests/reference/gbuffer_raster_checks.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr auto kPath = RasterPath::atomics64;

class GBufferRaster64 : public testing::Test {
  protected:
    void SetUp() override {
        if (!device().info().atomics64) GTEST_SKIP() << "the device has no 64-bit atomics";
    }
};

TEST_F(GBufferRaster64, TheNearestOfOverlappingTrianglesIsKeptWithItsDepth) {
    expectOverlappingTrianglesSorted(kPath);
}

TEST_F(GBufferRaster64, TrianglesThatReachBehindTheEyeAreCutAtTheNearPlane) {
    expectTrianglesCutByTheNearPlane(kPath);
}

TEST_F(GBufferRaster64, TextureFactorAndVertexColourDecideWhatAnAlphaTestKeeps) {
    expectAlphaDecidesFragments(kPath);
}

TEST_F(GBufferRaster64, MaskKeepsItsCutoffAndBlendIsOpaqueFromOne) {
    expectThresholdsAreKeptExactly(kPath);
}

TEST_F(GBufferRaster64, TrianglesOfEqualDepthGoToTheLowestIndex) {
    expectTiesGoToTheLowestIndex(kPath);
}

TEST_F(GBufferRaster64, WordsAreThoseOfTheTwin) {
    expectWordsOfTheTwin();
}

TEST_F(GBufferRaster64, BackFacesOfSingleSidedMaterialsAreDroppedAlsoWhereNodesMirror) {
    expectBackFacesAreDropped(kPath);
}

}  // namespace
}  // namespace penumbra::tests
