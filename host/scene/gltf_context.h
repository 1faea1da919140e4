// SPDX-License-Identifier: MIT
// What the stages of the glTF loader share, and the list of these stages. Only files named gltf_*
// include this header: tinygltf does not leave them.
//   bytes -> gltf_file (container, JSON, external files) -> tinygltf::Model
//         -> materials, images -> meshes -> nodes, skins -> animations -> cameras, lights -> Scene
// The stages throw Error without the file's name; gltf_loader.cpp puts it in front.
#pragma once
#include <tiny_gltf.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "host/scene/scene.h"
#include "runtime/error.h"
#include "runtime/one_line.h"

namespace penumbra::scene {

/// Largest sum of all decoded arrays and images. A small file can name one accessor, or one
/// strongly compressed image, thousands of times; this bounds what it can ask for.
/// A fuzzer's time goes to parsers, not to the filling of memory.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr std::uint64_t kMaxDecodedBytes = 4ULL << 20U;
#else
constexpr std::uint64_t kMaxDecodedBytes = 8ULL << 30U;
#endif

/// Largest sum of elements that have no bytes in the file and so are zeros: a hundred bytes can ask
/// for any number of them.
constexpr std::uint64_t kMaxZeroBytes = kMaxDecodedBytes / 32;

/// Images larger than this along a side are refused before they are decoded.
constexpr std::uint32_t kMaxImageSide = 8192;

struct LoadContext {
    LoadContext(const tinygltf::Model& source, Scene& target) : model(source), scene(target) {}

    const tinygltf::Model& model;
    Scene& scene;
    std::vector<std::string> imagePaths;      ///< [image] external path for messages, else empty
    std::map<int, int> sceneImageOfGltf;      ///< glTF image -> Scene::images; -1: cannot be used
    std::vector<int> largestJoint;            ///< [mesh] largest joint with a weight; -1: rigid
    std::vector<std::size_t> targetsPerMesh;  ///< [mesh] number of morph targets
    int defaultMaterial = -1;                 ///< made when a primitive first needs it

    /// Adds to Scene::warnings unless the same text is there already.
    void warn(const std::string& message);
    /// Takes count * bytesEach from what may be decoded; throws before anything is allocated.
    void charge(std::uint64_t count, std::uint64_t bytesEach, const std::string& what);
    /// The same for elements that are zeros because the file has none; these are charged twice.
    void chargeZeros(std::uint64_t count, std::uint64_t bytesEach, const std::string& what);

  private:
    std::uint64_t bytesLeft_ = kMaxDecodedBytes, zeroBytesLeft_ = kMaxZeroBytes;
    std::set<std::string> warned_;
};

/// `mesh 3 "arm"`, or `mesh 3` without a name.
std::string describe(const char* kind, std::size_t index, const std::string& name);

/// Throws unless 0 <= index < size. `user` refers to `kind` number `index`.
void checkIndex(int index, std::size_t size, const std::string& user, const char* kind);

/// Extensions: those in extensionsRequired must be ours, the other ones that we ignore are named.
void checkExtensions(LoadContext& context);

void loadMaterials(LoadContext& context);
/// Index into Scene::images; -1, with a warning, for formats other than PNG and JPEG.
int loadImage(LoadContext& context, int gltfImage);
void loadMeshes(LoadContext& context);
void loadNodes(LoadContext& context);  ///< also Scene::order
void loadSkins(LoadContext& context);  ///< needs meshes and nodes
void loadAnimations(LoadContext& context);
/// These two need the pose of rest, `worldFromNode` [node].
void loadCameras(LoadContext& context, const std::vector<glm::dmat4>& worldFromNode);
void loadLights(LoadContext& context, const std::vector<glm::dmat4>& worldFromNode);

}  // namespace penumbra::scene
