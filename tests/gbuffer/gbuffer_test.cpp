// SPDX-License-Identifier: MIT
// Surface attributes of the G-buffer: interpolation, culling, alpha tests, both raster paths.
#include "kernels/shared/gbuffer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "tests/reference/gbuffer_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr int kWidth = 61, kHeight = 37;

scene::CameraFrame frontCamera() {
    return perspectiveCamera({0, 0, 4}, {0, 0, 0}, 50);
}

/// Random double-sided triangles in front of the camera, a node each.
SceneBuilder randomTriangles(unsigned seed, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-2, 2), deep(-6, 3);
    SceneBuilder builder;
    builder.material().doubleSided = true;
    for (int i = 0; i < count; ++i) {
        std::vector<glm::vec3> corners;
        for (int c = 0; c < 3; ++c) corners.push_back({at(random), at(random), deep(random)});
        builder.addMesh(corners, {0, 1, 2});
    }
    return builder;
}

const scene::Primitive& primitiveOf(const scene::Scene& scene, std::uint32_t object) {
    const auto mesh = static_cast<std::size_t>(scene.nodes[object - 1].mesh);
    return scene.meshes[mesh].primitives[0];
}

/// A unit square towards the camera, corners at +-1, uv (0, 0) at the top left; lone node of the
/// scene.
scene::Scene texturedSquare(const std::vector<std::uint8_t>& texels, int size) {
    SceneBuilder builder;
    builder.addQuad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    auto& scene = builder.scene();
    scene.images.push_back({size, size, texels});
    auto& material = scene.materials[0];
    material.baseColor = glm::vec4(1);
    material.baseColorTexture.image = 0;
    material.baseColorTexture.nearest = true;
    auto& primitive = scene.meshes[0].primitives[0];
    for (const auto& p : primitive.positions)
        primitive.uvs[0].emplace_back(0.5F + 0.5F * p.x, 0.5F - 0.5F * p.y);
    return scene;
}

int coveredPixels(const GBufferRun& run) {
    int count = 0;
    for (int y = 0; y < run.height; ++y)
        for (int x = 0; x < run.width; ++x) count += run.object(x, y) != 0;
    return count;
}

TEST(GBuffer, BothAtomicPathsGiveTheSameBytes) {
    for (unsigned seed = 0; seed < 3; ++seed) {
        const auto scene = randomTriangles(seed, 200).scene();
        const auto wide = runGBuffer(scene, frontCamera(), kWidth, kHeight);
        const auto narrow = runGBuffer(scene, frontCamera(), kWidth, kHeight, glm::dvec3(0), false);
        ASSERT_EQ(wide.planes.size(), narrow.planes.size());
        EXPECT_EQ(std::memcmp(wide.planes.data(), narrow.planes.data(),
                              wide.planes.size() * sizeof(float)),
                  0);
    }
}

TEST(GBuffer, PositionsLieOnTheTriangleAndOnThePixelsRay) {
    const auto scene = randomTriangles(5, 60).scene();
    const auto camera = frontCamera();
    const auto run = runGBuffer(scene, camera, kWidth, kHeight);
    const glm::dvec3 eye(camera.worldFromCamera[3]);
    int checked = 0, offRay = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (run.object(x, y) == 0) continue;
            const auto& p = primitiveOf(scene, run.object(x, y)).positions;
            const glm::dvec3 a(p[0]), b(p[1]), c(p[2]), at = run.vector(GB_POSITION, x, y);
            const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
            EXPECT_LT(std::abs(glm::dot(at - a, normal)), 1e-5 * 8) << x << ' ' << y;
            const glm::dvec3 ray = pixelRay(camera, kWidth, kHeight, x, y);
            const double distance = glm::length(glm::cross(at - eye, glm::normalize(ray)));
            // Snapping may put a centre outside of a sliver: then the nearest point of it is taken
            offRay += distance > 1e-4;
            ++checked;
            EXPECT_NEAR(run.value(GB_DEPTH, x, y), 4 - at.z, 1e-5);
            EXPECT_GE(glm::dot(run.vector(GB_GEOMETRIC, x, y), eye - at), 0);
            EXPECT_NEAR(std::abs(glm::dot(run.vector(GB_GEOMETRIC, x, y), normal)), 1, 1e-5);
        }
    EXPECT_GT(checked, 1500);
    EXPECT_LT(offRay, checked / 200);
}

TEST(GBuffer, VertexColoursAreInterpolatedInPerspective) {
    SceneBuilder builder;
    builder.material().doubleSided = true;
    builder.material().baseColor = {0.5F, 1, 1, 1};
    // A floor that runs far away: interpolation on the screen would be wrong by far
    builder.addQuad({-2, -1, 3}, {4, 0, 0}, {0, 0, -23});
    auto& primitive = builder.scene().meshes[0].primitives[0];
    for (const auto& p : primitive.positions)
        primitive.colors.emplace_back((p.x + 2) / 4, p.z < 0 ? 1 : 0, 0, 1);
    const auto run = runGBuffer(builder.scene(), frontCamera(), kWidth, kHeight);
    int checked = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            if (run.object(x, y) == 0) continue;
            const auto at = run.vector(GB_POSITION, x, y), albedo = run.vector(GB_ALBEDO, x, y);
            EXPECT_NEAR(albedo.x, 0.5 * (at.x + 2) / 4, 1e-4);
            EXPECT_NEAR(albedo.y, (3 - at.z) / 23, 1e-4);
            EXPECT_EQ(albedo.z, 0);
            ++checked;
        }
    EXPECT_GT(checked, 400);
}

TEST(GBuffer, TexturesAreReadAtTheInterpolatedUv) {
    constexpr int kSize = 64;
    std::vector<std::uint8_t> texels;
    for (int v = 0; v < kSize; ++v)
        for (int u = 0; u < kSize; ++u)
            for (const int value : {u * 4, v * 4, 0, 255})
                texels.push_back(static_cast<std::uint8_t>(value));
    auto scene = texturedSquare(texels, kSize);
    scene.nodes[0].matrix[0][2] = 0.8;  // sheared away from the camera
    scene.nodes[0].matrix[2][2] = 1;
    const int width = 305, height = 185;  // a texel is larger than a pixel: the finest level
    const auto run = runGBuffer(scene, frontCamera(), width, height);
    int checked = 0, wrong = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            if (run.object(x, y) == 0) continue;
            const auto at = run.vector(GB_POSITION, x, y), albedo = run.vector(GB_ALBEDO, x, y);
            const double uv[2] = {(0.5 + 0.5 * at.x) * kSize, (0.5 - 0.5 * at.y) * kSize};
            for (int axis = 0; axis < 2; ++axis) {
                if (std::abs(uv[axis] - std::round(uv[axis])) < 1e-3) continue;
                const double byte = std::floor(uv[axis]) * 4 / 255;
                const double linear =
                    byte <= 0.04045 ? byte / 12.92 : std::pow((byte + 0.055) / 1.055, 2.4);
                wrong += std::abs(albedo[axis] - linear) > 1e-5;
                ++checked;
            }
        }
    EXPECT_GT(checked, 10000);
    EXPECT_EQ(wrong, 0);
}

TEST(GBuffer, SingleSidedSurfacesAreSeenFromTheFrontOnly) {
    SceneBuilder builder;
    builder.addQuad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    auto scene = builder.scene();
    EXPECT_GT(coveredPixels(runGBuffer(scene, frontCamera(), kWidth, kHeight)), 100);
    const auto behind = perspectiveCamera({0, 0, -4}, {0, 0, 0}, 50);
    EXPECT_EQ(coveredPixels(runGBuffer(scene, behind, kWidth, kHeight)), 0);
    scene.materials[0].doubleSided = true;
    EXPECT_GT(coveredPixels(runGBuffer(scene, behind, kWidth, kHeight)), 100);
}

TEST(GBuffer, MirroredNodesKeepTheirFront) {
    SceneBuilder builder;
    builder.addQuad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    auto scene = builder.scene();
    scene.nodes[0].matrix[0][0] = -1;  // still faces +z
    const auto run = runGBuffer(scene, frontCamera(), kWidth, kHeight);
    EXPECT_GT(coveredPixels(run), 100);
    EXPECT_NEAR(run.vector(GB_NORMAL, 30, 18).z, 1, 1e-6);
    scene.nodes[0].matrix[0][0] = 1;
    scene.nodes[0].matrix[2][2] = -1;  // mirrored along its normal: now faces -z
    EXPECT_EQ(coveredPixels(runGBuffer(scene, frontCamera(), kWidth, kHeight)), 0);
}

TEST(GBuffer, MaskedFragmentsBelowTheCutoffShowWhatLiesBehind) {
    // A checkerboard of 2 x 2 texels: alpha 255 at the upper left and lower right
    std::vector<std::uint8_t> texels;
    for (const int alpha : {255, 0, 0, 255})
        for (const int value : {255, 255, 255, alpha})
            texels.push_back(static_cast<std::uint8_t>(value));
    auto scene = texturedSquare(texels, 2);
    scene.materials[0].alphaMode = scene::AlphaMode::mask;
    for (const bool wide : {true, false}) {
        const auto run = runGBuffer(scene, frontCamera(), kWidth, kHeight, glm::dvec3(0), wide);
        EXPECT_EQ(run.object(26, 14), 1U);
        EXPECT_EQ(run.object(34, 22), 1U);
        EXPECT_EQ(run.object(34, 14), 0U);
        EXPECT_EQ(run.object(26, 22), 0U);
        EXPECT_TRUE(std::isinf(run.value(GB_DEPTH, 34, 14)));
    }
    scene.materials[0].alphaMode = scene::AlphaMode::opaque;
    EXPECT_EQ(runGBuffer(scene, frontCamera(), kWidth, kHeight).object(34, 14), 1U);
}

TEST(GBuffer, AlphaEqualToTheCutoffIsKept) {
    SceneBuilder builder;
    builder.addQuad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    auto& material = builder.scene().materials[0];
    material.alphaMode = scene::AlphaMode::mask;
    material.alphaCutoff = 0.5F;
    material.baseColor.w = 0.5F;
    EXPECT_EQ(runGBuffer(builder.scene(), frontCamera(), kWidth, kHeight).object(30, 18), 1U);
    material.baseColor.w = 0.49F;
    EXPECT_EQ(runGBuffer(builder.scene(), frontCamera(), kWidth, kHeight).object(30, 18), 0U);
}

}  // namespace
}  // namespace penumbra::tests
