// SPDX-License-Identifier: MIT
// What the camera sees, against primary rays through the pixels' centres.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "host/scene/builtin.h"
#include "host/scene/gltf_loader.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/embree_scene.h"
#include "tests/reference/gbuffer_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr int kWidth = 320, kHeight = 240;

struct Seen {
    std::uint32_t object = 0;
    double depth = 0;
};

/// True if the ray meets the side of a single-sided triangle that the camera does not see.
bool isHiddenSide(const scene::Scene& scene, const scene::Pose& pose, const PosedTriangle& triangle,
                  const glm::dvec3& ray) {
    const auto& node = scene.nodes[static_cast<std::size_t>(triangle.node)];
    const auto& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
    const auto& primitive = mesh.primitives[static_cast<std::size_t>(triangle.primitive)];
    if (scene.materials[static_cast<std::size_t>(primitive.material)].doubleSided) return false;
    const auto& c = triangle.corners;
    double side = glm::dot(glm::cross(c[1] - c[0], c[2] - c[0]), ray);
    const bool rigid = node.skin < 0 || primitive.joints.empty();
    const auto& world = pose.worldFromNode[static_cast<std::size_t>(triangle.node)];
    if (rigid && glm::determinant(glm::dmat3(world)) < 0) side = -side;
    return side > 0;
}

Seen trace(const EmbreeScene& embree, const scene::Scene& scene, const scene::Pose& pose,
           const glm::dvec3& eye, const glm::dvec3& ray, double near) {
    double nearest = near;
    for (int tries = 0; tries < 64; ++tries) {
        const auto hit = embree.trace(glm::vec3(eye), glm::vec3(ray), static_cast<float>(nearest));
        if (hit.triangle < 0) return {};
        const auto& triangle = embree.triangles()[static_cast<std::size_t>(hit.triangle)];
        if (!isHiddenSide(scene, pose, triangle, ray))
            return {static_cast<std::uint32_t>(triangle.node) + 1, hit.t};
        nearest = hit.t * (1 + 1e-6);
    }
    return {};
}

bool agrees(const Seen& a, const Seen& b) {
    return a.object == b.object && (a.object == 0 || std::abs(a.depth - b.depth) < 1e-3 * b.depth);
}

/// Pixels where rays within 0.02 pixels of the centre see the same, and the rasteriser something
/// else; and pixels that differ at all.
void compare(const std::string& name, const scene::Scene& scene, double seconds) {
    const auto clips = scene::chooseAnimations(scene, "");
    const auto bounds = scene::clipBounds(scene, clips);
    ShadowSetup setup;
    setup.placedCamera = false;
    setup.width = kWidth, setup.height = kHeight;
    setup.seconds = seconds;
    setup.samples = "1";
    setup.settings = {{"vwss.resolution", "64"}};
    const auto run = runShadows(scene, setup);
    const auto camera =
        scene::cameraAt(scene, run.pose, {}, bounds, static_cast<double>(kWidth) / kHeight);
    ASSERT_FALSE(camera.orthographic);
    const EmbreeScene embree(scene, run.pose, bounds.centre(), false);
    const glm::dvec3 eye = glm::dvec3(camera.worldFromCamera[3]) - bounds.centre();
    int differing = 0, wrong = 0, covered = 0;
    const auto ray = [&](double x, double y) {
        const glm::dvec3 a = pixelRay(camera, kWidth, kHeight, 0, 0);
        const glm::dvec3 dx = pixelRay(camera, kWidth, kHeight, 1, 0) - a;
        const glm::dvec3 dy = pixelRay(camera, kWidth, kHeight, 0, 1) - a;
        return a + x * dx + y * dy;
    };
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const auto i = static_cast<std::size_t>(y * kWidth + x);
            Seen seen;
            std::memcpy(&seen.object, &run.planes[GB_OBJECT * run.stride + i], sizeof seen.object);
            seen.depth = run.planes[GB_DEPTH * run.stride + i];
            covered += seen.object != 0;
            if (agrees(seen, trace(embree, scene, run.pose, eye, ray(x, y), camera.nearMetres)))
                continue;
            ++differing;
            bool explained = false;
            for (int k = 0; k < 8; ++k)
                explained |= agrees(seen, trace(embree, scene, run.pose, eye,
                                                ray(x + 0.02 * std::cos(k * M_PI / 4),
                                                    y + 0.02 * std::sin(k * M_PI / 4)),
                                                camera.nearMetres));
            wrong += !explained;
        }
    std::printf("[ PRIMARY  ] %s: %d covered, %d differ, %d of them away from silhouettes\n",
                name.c_str(), covered, differing, wrong);
    EXPECT_GT(covered, kWidth * kHeight / 100) << name;
    EXPECT_EQ(wrong, 0) << name;
    EXPECT_LE(differing, kWidth * kHeight / 1000) << name;
}

TEST(RasterEmbree, BuiltinSceneIsSeenAsByRays) {
    const auto scene = scene::loadBuiltinScene();
    for (const double seconds : {0.0, 0.4, 1.1}) compare("built-in", scene, seconds);
}

TEST(RasterEmbree, ModelsAreSeenAsByRays) {
    ASSET_OR_SKIP(folder, "");
    for (const char* name :
         {"Fox/Fox.glb", "CesiumMan/CesiumMan.glb", "RecursiveSkeletons/RecursiveSkeletons.glb",
          "AnimatedMorphCube/AnimatedMorphCube.glb", "OrientationTest/OrientationTest.glb",
          "Robot/robot.glb", "BoxAnimated/BoxAnimated.glb", "SimpleSkin/SimpleSkin.gltf"})
        compare(name, scene::loadGltf(folder + name), 0.7);
}

}  // namespace
}  // namespace penumbra::tests
