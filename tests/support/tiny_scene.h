// SPDX-License-Identifier: MIT
// A scene small enough for Oclgrind.
#pragma once
#include "host/penumbra.h"
#include "host/scene/scene.h"

namespace penumbra::tests {

/// A box over a floor with every kind of material: plain, masked by a texture, blended,
/// normal-mapped; lit by the square light "key".
scene::Scene tinyScene();

/// An image of it that fills no whole work-group, by 3 light samples.
RenderOptions tinyOptions();

}  // namespace penumbra::tests
