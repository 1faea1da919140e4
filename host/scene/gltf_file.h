// SPDX-License-Identifier: MIT
// Bytes to tinygltf::Model: container, JSON, buffers, encoded images, external files.
#pragma once
#include <tiny_gltf.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace penumbra::scene {

/// Largest file that is read: tinygltf and stb count bytes in int.
constexpr std::uint64_t kMaxFileBytes = (1ULL << 31U) - 1;
/// Largest sum of the external files of a scene; a file may name one of them again and again.
constexpr std::uint64_t kMaxExternalBytes = 4ULL << 30U;

/// The files beside a scene. Nothing outside of `folder` is read.
struct ExternalFiles {
    bool allowed = false;          ///< false: a scene in memory has no folder
    std::filesystem::path folder;  ///< canonical
    std::uint64_t bytesLeft = kMaxExternalBytes;
};

/// The whole regular file; throws Error where it is absent, something else or too large.
std::vector<unsigned char> readFile(const std::filesystem::path& path);

/// Parses .glb (by its magic) or .gltf text. Buffers are complete afterwards; images hold their
/// encoded bytes in `image` unless they lie in a buffer view. Adds what tinygltf complained of to
/// `warnings`. Ranges inside of the model are NOT checked here.
tinygltf::Model parseGltf(const unsigned char* bytes, std::size_t size, ExternalFiles& files,
                          std::vector<std::string>& warnings);

}  // namespace penumbra::scene
