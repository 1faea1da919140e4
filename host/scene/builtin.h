// SPDX-License-Identifier: MIT
#pragma once
#include "host/scene/scene.h"

namespace penumbra::scene {

/// The scene that is rendered where none is named; written by tools/make_scene at build time.
Scene loadBuiltinScene();

}  // namespace penumbra::scene
