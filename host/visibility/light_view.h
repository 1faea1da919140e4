// SPDX-License-Identifier: MIT
// Fits the views of a light to the casters.
#pragma once
#include "host/scene/bounds.h"
#include "host/scene/light.h"
#include "kernels/shared/multi_view.h"
#include "kernels/shared/raster.h"

namespace penumbra::visibility {

/// The views of one light for maps of resolution^2 texels.
struct LightView {
    shared::MultiViewParams
        params{};  ///< pointCapacity, precision, alphaKeys, depthBits: the technique's
    shared::RasterView enlarged{};  ///< the view that holds all views; flags: the technique's
    shared::RasterView
        central{};               ///< of the light's centre, as large as a map; depth: near clip / z
    std::vector<float> samples;  ///< [view, 2] kx, ky of shared/multi_view.h
    bool disk = false;           ///< the light's shape
    double farthestCaster = 1;   ///< metres along the light's axis
    bool complete = true;        ///< every view holds all casters: what lies outside is lit
    double density = 1;          ///< what is left of the density asked for after the cap of 8192
};

/// Fits field of view and near plane (DESIGN: smallest square field of view that holds all casters
/// from every sample, plus 2 %, at most 140 degrees; near = 0.9 x the nearest caster's depth, at
/// least 0.25 x the light's larger side) and derives the enlarged view of [VWSS] equations 1-3, its
/// resolution times `density`, rounded up. `centre` is what the world was re-based to.
LightView fitLightView(const scene::AreaLight& light, const scene::Bounds& casters,
                       const glm::dvec3& centre, int resolution, double density);

/// Step of the opacity shuffle of kernels/lib/opacity.h through N ranks: near to the golden ratio
/// and coprime to N.
int shuffleStride(int views);

}  // namespace penumbra::visibility
