// SPDX-License-Identifier: MIT
// Blue-noise samples of a square or a disk.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace penumbra::scene {

/// Exactly `count` points of [-1, 1]^2, or of the unit disk, none nearer to another than a distance
/// that is as large as was found for so many. Source: Bridson, Fast Poisson Disk Sampling in
/// Arbitrary Dimensions, SIGGRAPH 2007; the distance is searched, and where no distance gives
/// exactly `count`, the last points found are left out. The same points on every machine.
std::vector<glm::dvec2> poissonDisk(int count, bool disk, std::uint32_t seed);

/// The next number of a PCG hash in (0, 1).
double uniform(std::uint32_t& state);

}  // namespace penumbra::scene
