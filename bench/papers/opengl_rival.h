// SPDX-License-Identifier: MIT
// OpenGL by Mesa's llvmpipe as a rival on the scenes of the tables.
#pragma once
#include "bench/papers/papers.h"

namespace penumbra::papers {

/// Milliseconds of wall clock, best of three, of `maps` depth maps of 1024^2 of a scene's first
/// light, one draw a map, all by the caller's thread.
double openGlMs(const Request& request, const std::string& scene, int maps);

}  // namespace penumbra::papers
