// SPDX-License-Identifier: MIT
// Loads every model of the shared assets and counts the triangles that its scene draws. The counts
// are those of the assets' own list (ASSETS.md), which a script took from the accessors.
#include <chrono>
#include <cstdlib>
#include <map>

#include "tests/scene/gltf_test_file.h"

#ifndef PENUMBRA_SOURCE_DIR
#define PENUMBRA_SOURCE_DIR "."
#endif

namespace penumbra::scene {
namespace {

std::filesystem::path assetsFolder() {
    const char* const chosen = std::getenv("PENUMBRA_ASSETS");
    const std::string folder = chosen != nullptr ? chosen : "../shared/assets";
    return std::filesystem::path(PENUMBRA_SOURCE_DIR) / folder;  // an absolute folder replaces it
}

std::size_t countDrawnTriangles(const Scene& scene) {
    std::size_t triangles = 0;
    for (const int node : scene.order) {
        const int mesh = scene.nodes[static_cast<std::size_t>(node)].mesh;
        if (mesh < 0) continue;
        for (const Primitive& primitive : scene.meshes[static_cast<std::size_t>(mesh)].primitives)
            triangles += primitive.indices.size() / 3;
    }
    return triangles;
}

const std::map<std::string, std::size_t>& drawnTriangles() {
    static const std::map<std::string, std::size_t> kDrawn = {
        {"CesiumMan.glb", 4672},
        {"Fox.glb", 576},
        {"RiggedFigure.glb", 256},
        {"RiggedSimple.glb", 188},
        {"SimpleSkin.gltf", 8},
        {"RecursiveSkeletons.glb", 6384},
        {"Knight.glb", 6952},
        {"Mage.glb", 5683},
        {"robot.glb", 3238},
        {"greenman.glb", 356},
        {"room.glb", 63720},
        {"dutch_ship_medium_1k.gltf", 69162},
        {"StainedGlassLamp.gltf", 35132},
        {"GlassVaseFlowers.glb", 14036},
        {"AlphaBlendModeTest.glb", 61},
        {"ToyCar.gltf", 108936},
        {"MetalRoughSpheresNoTextures.glb", 1040409},
        {"InterpolationTest.glb", 110},
        {"OrientationTest.glb", 524},
        {"AnimatedMorphCube.glb", 12},
        {"SimpleSparseAccessor.gltf", 12},
        {"BoxAnimated.glb", 254},
        {"robot_parts_a.gltf", 514410}};
    return kDrawn;
}

TEST(GltfAssetsTest, EveryModelDrawsTheTrianglesOfItsList) {
    if (!std::filesystem::is_directory(assetsFolder()))
        GTEST_SKIP() << "no folder " << assetsFolder() << "; set PENUMBRA_ASSETS to run this test";
    std::size_t checked = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(assetsFolder())) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".glb" && extension != ".gltf") continue;
        const auto start = std::chrono::steady_clock::now();
        const Scene scene = loadGltf(entry.path().string());
        const std::chrono::duration<double, std::milli> elapsed =
            std::chrono::steady_clock::now() - start;
        const auto expected = drawnTriangles().find(entry.path().filename().string());
        ASSERT_NE(expected, drawnTriangles().end()) << entry.path() << " is not in the list";
        EXPECT_EQ(countDrawnTriangles(scene), expected->second) << entry.path();
        for (const std::string& warning : scene.warnings)
            EXPECT_EQ(warning.rfind("extension KHR_materials_", 0), 0U)
                << entry.path() << ": " << warning;
        std::printf("%8.1f ms  %s\n", elapsed.count(), entry.path().filename().c_str());
        ++checked;
    }
    EXPECT_EQ(checked, drawnTriangles().size());
}

}  // namespace
}  // namespace penumbra::scene
