// SPDX-License-Identifier: MIT
// Triangles of one size that fill a screen, for the benchmarks of the rasteriser.
#pragma once
#include "host/scene/camera.h"
#include "host/scene/scene.h"

namespace penumbra::bench {

constexpr int kGridPixels = 1024;  ///< width and height of the screen

/// A grid of triangles whose legs are `pixels` long, `layers` deep, the farthest last. uvs run from
/// 0 to 1 over the screen.
scene::Scene triangleGrid(int pixels, int layers);
/// The camera whose screen the grid fills.
scene::CameraFrame gridCamera();

}  // namespace penumbra::bench
