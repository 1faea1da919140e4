// SPDX-License-Identifier: MIT
#include "host/scene/builtin.h"

#include "host/scene/gltf_loader.h"

extern "C" const unsigned char penumbraBuiltinScene[];
extern "C" const unsigned char penumbraBuiltinSceneEnd[];

namespace penumbra::scene {

Scene loadBuiltinScene() {
    const auto size = static_cast<std::size_t>(penumbraBuiltinSceneEnd - penumbraBuiltinScene);
    return loadGlb(penumbraBuiltinScene, size, "built-in scene");
}

}  // namespace penumbra::scene
