// SPDX-License-Identifier: MIT
// Bytes of a .gltf or .glb file -> scene -> all that the host computes for a frame of 32 x 32
// pixels, up to what would be uploaded.
#include <cmath>

#include "host/geometry/materials.h"
#include "host/geometry/mesh_arrays.h"
#include "host/scene/camera.h"
#include "host/scene/digest.h"
#include "host/scene/gltf_loader.h"
#include "host/scene/light.h"
#include "host/visibility/light_view.h"
#include "tests/fuzz/expect_one_line.h"

namespace penumbra::fuzz {
namespace {

constexpr int kSize = 32, kMapSize = 64;

void expectFinite(const shared::float4& row, const char* what) {
    expect(std::isfinite(row.x) && std::isfinite(row.y) && std::isfinite(row.z) &&
               std::isfinite(row.w),
           what);
}

void expectFinite(const shared::RasterView& view, const char* what) {
    for (const auto& row : {view.rowX, view.rowY, view.rowW, view.rowD}) expectFinite(row, what);
}

void prepareGeometry(const scene::Scene& scene) {
    std::vector<int> firstMatrix, firstWeight;
    int matrices = static_cast<int>(scene.nodes.size()), weights = 0;
    for (const auto& skin : scene.skins) {
        firstMatrix.push_back(matrices);
        matrices += static_cast<int>(skin.joints.size());
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) firstWeight.push_back(weights++);
    const auto arrays = geometry::flatten(scene, firstMatrix, firstWeight);
    for (const auto index : arrays.indices)
        expect(index < arrays.vertexItem.size(), "indices within the vertices");
    for (const auto draw : arrays.triangleDraw)
        expect(draw < arrays.draws.size(), "triangles of draws");
    geometry::packMaterials(scene);
    scene::sceneDigest(scene);
}

void prepareFrame(const scene::Scene& scene, const scene::Bounds& bounds, double seconds) {
    const auto clips = scene::chooseAnimations(scene, "");
    const auto pose = scene::poseAt(scene, clips, seconds);
    const auto camera = scene::cameraAt(scene, pose, {}, bounds, 1);
    expectFinite(scene::rasterView(camera, bounds.centre(), kSize, kSize), "a finite camera");
    scene::SampleChoice samples;
    samples.count = 4;
    for (const auto& light : scene::lightsAt(scene, pose, bounds, samples)) {
        scene::facingIrradiance(light, bounds.centre());
        const auto view = visibility::fitLightView(light, bounds, bounds.centre(), kMapSize, 1);
        expectFinite(view.enlarged, "a finite view of a light");
        expectFinite(view.central, "a finite central view of a light");
    }
}

void prepareFrames(scene::Scene scene) {
    const auto clips = scene::chooseAnimations(scene, "");
    const auto bounds = scene::clipBounds(scene, clips);
    scene::addGround(scene, bounds);
    prepareGeometry(scene);
    prepareFrame(scene, bounds, 0);
    prepareFrame(scene, bounds, scene::clipDurationSeconds(scene, clips));
}

}  // namespace
}  // namespace penumbra::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace penumbra;
    fuzz::expectOneLine([&] { fuzz::prepareFrames(scene::loadGlb(bytes, size, "fuzz.glb")); });
    return 0;
}
