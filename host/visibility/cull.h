// SPDX-License-Identifier: MIT
// Which faces of casters a light does not see.
#pragma once
#include "kernels/shared/mesh.h"
#include "kernels/shared/raster.h"

namespace penumbra::visibility {

/// automatic: back faces of edge-closed meshes; back, front: of all meshes; none: occluders are
/// two-sided.
enum class Cull { automatic, back, front, none };

/// Casters alone, without the culled faces.
inline void selectCasters(Cull cull, shared::RasterView& view) {
    view.requireFlags = DRAW_CASTS;
    if (cull == Cull::automatic) view.cullBack = DRAW_CLOSED;
    if (cull == Cull::back) view.cullBack = DRAW_ANY;
    if (cull == Cull::front) view.cullFront = DRAW_ANY;
}

}  // namespace penumbra::visibility
