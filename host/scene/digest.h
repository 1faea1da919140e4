// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "host/scene/scene.h"

namespace penumbra::scene {

/// Digest of all that a picture can depend on; equal scenes have equal digests, wherever they lie.
std::string sceneDigest(const Scene& scene);

}  // namespace penumbra::scene
