// SPDX-License-Identifier: MIT
// The order of the loader's stages; each is one gltf_*.cpp file. See gltf_context.h for the flow.
#include "host/scene/gltf_loader.h"

#include <cmath>
#include <new>

#include "host/scene/animation.h"
#include "host/scene/gltf_context.h"
#include "host/scene/gltf_file.h"

namespace penumbra::scene {

namespace {

/// Finite parts can still multiply to something infinite, deep in a hierarchy.
void checkRestPose(const Scene& scene, const Pose& rest) {
    for (const int node : scene.order) {
        bool finite = true;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                finite =
                    finite &&
                    std::isfinite(rest.worldFromNode[static_cast<std::size_t>(node)][column][row]);
        require(finite, "{} has a world matrix that is not finite",
                describe("node", static_cast<std::size_t>(node),
                         scene.nodes[static_cast<std::size_t>(node)].name));
    }
}

Scene loadBytes(const unsigned char* bytes, std::size_t size, ExternalFiles& files,
                const std::string& name) {
    std::vector<std::string> complaints;
    const tinygltf::Model model = parseGltf(bytes, size, files, complaints);
    Scene scene;
    scene.name = name;
    LoadContext context(model, scene);
    for (const std::string& complaint : complaints) context.warn(complaint);
    checkExtensions(context);
    loadMaterials(context);
    loadMeshes(context);
    loadNodes(context);
    loadSkins(context);
    loadAnimations(context);
    const Pose rest = poseAt(scene, {}, 0);
    checkRestPose(scene, rest);
    loadCameras(context, rest.worldFromNode);
    loadLights(context, rest.worldFromNode);
    return scene;
}

/// Runs `load` and puts the file's name in front of whatever goes wrong.
template <typename Load>
Scene named(const std::string& name, const Load& load) {
    try {
        return load();
    } catch (const Error& error) {
        throw Error(fmt::format("{}: {}", name, toOneLine(error.what())), error.code());
    } catch (const std::bad_alloc&) {
        throw Error(fmt::format("{}: there is not enough memory to load it", name),
                    ExitCode::outOfMemory);
    } catch (const std::exception& error) {  // tinygltf's containers, on input we failed to foresee
        throw Error(fmt::format("{}: is not valid: {}", name, toOneLine(error.what())));
    }
}

}  // namespace

Scene loadGltf(const std::string& path) {
    return named(path, [&] {
        const std::vector<unsigned char> bytes = readFile(path);
        ExternalFiles files;
        files.allowed = true;
        files.folder = std::filesystem::canonical(std::filesystem::absolute(path).parent_path());
        return loadBytes(bytes.data(), bytes.size(), files,
                         std::filesystem::path(path).stem().string());
    });
}

Scene loadGlb(const void* bytes, std::size_t size, const std::string& name) {
    return named(name, [&] {
        ExternalFiles files;
        return loadBytes(static_cast<const unsigned char*>(bytes), size, files, name);
    });
}

}  // namespace penumbra::scene
