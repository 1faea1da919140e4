// SPDX-License-Identifier: MIT
// What both paths of the rasteriser have to pass: their kernels run alone and are compared with
// gbuffer_raster_ref.h, on images that fill no whole work-group.
#pragma once

namespace penumbra::tests {

enum class RasterPath { atomics32, atomics64 };

/// Small and large triangles in any order; depths and indices per pixel.
void expectOverlappingTrianglesSorted(RasterPath path);
/// Triangles all around the eye.
void expectTrianglesCutByTheNearPlane(RasterPath path);
/// MASK and BLEND by factor x texture x vertex colour.
void expectAlphaDecidesFragments(RasterPath path);
/// Alpha that equals its threshold.
void expectThresholdsAreKeptExactly(RasterPath path);
/// Without rounding: coordinates are multiples of 1/64 pixel, depths exact in float.
void expectTiesGoToTheLowestIndex(RasterPath path);
/// The words of 64 bits, as later passes read them, on the same scenes.
void expectWordsOfTheTwin();
/// Single-sided materials, also in nodes of negative determinant.
void expectBackFacesAreDropped(RasterPath path);

}  // namespace penumbra::tests
