// SPDX-License-Identifier: MIT
// Scenes of triangles whose alpha comes from textures and vertex colours, in every alpha mode.
#pragma once
#include <string>
#include <vector>

#include "host/scene/scene.h"

namespace penumbra::tests {

/// Surfaces that textured scenes are made of; the order is that of their materials from 1 on.
enum class Surface { opaque, maskNearest, maskSmooth, blend, blendTexture, transmission, glass };

/// A floor at y = 0 that casts nothing (material 0), and above it, per surface, a node of
/// `triangles` random triangles with texture coordinates, vertex colours and a transform; every
/// other node is mirrored. y of casters lies within 0.4 and 2.6 metres, x and z within 1.8.
scene::Scene texturedScene(unsigned seed, int triangles, const std::vector<Surface>& surfaces);

/// The light that the scenes are made for.
inline const std::string kTexturedLight = "rect:at=0.3,6,-0.4;aim=0,0,0;size=1.2x0.8;radiance=10";

}  // namespace penumbra::tests
