// SPDX-License-Identifier: MIT
// glTF 2.0 in, Scene out. tinygltf ends here.
#pragma once
#include <cstddef>
#include <string>

#include "host/scene/scene.h"

namespace penumbra::scene {

/// Loads a .gltf or .glb file. Throws Error (exit code 1, one line that names the file and what was
/// found) for anything absent, malformed, out of range or unsupported; never trusts a count,
/// offset, stride or index of the file. External paths may not leave the file's folder.
Scene loadGltf(const std::string& path);

/// The same for a .glb in memory (the built-in scene); `name` stands for the file in messages.
Scene loadGlb(const void* bytes, std::size_t size, const std::string& name);

}  // namespace penumbra::scene
