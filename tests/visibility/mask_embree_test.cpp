// SPDX-License-Identifier: MIT
// Shadows of alpha-tested textures against Embree, which finds each crossing, and the glTF rules in
// double, which say whether a crossing blocks.
#include <cmath>
#include <cstdio>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/embree_scene.h"
#include "tests/reference/surface_ref.h"
#include "tests/support/fixtures.h"
#include "tests/support/textured_scene.h"

namespace penumbra::tests {
namespace {

const scene::Primitive& primitiveOf(const scene::Scene& scene, const PosedTriangle& triangle) {
    const auto mesh = scene.nodes[static_cast<std::size_t>(triangle.node)].mesh;
    return scene.meshes[static_cast<std::size_t>(mesh)]
        .primitives[static_cast<std::size_t>(triangle.primitive)];
}

/// Follows a ray from crossing to crossing until one blocks or the sample is reached.
bool blocked(const scene::Scene& scene, const EmbreeScene& embree, const glm::vec3& from,
             const glm::vec3& to) {
    float begin = 0;
    for (;;) {
        const auto hit = embree.trace(from, to - from, begin);
        if (hit.triangle < 0 || hit.t >= 1) return false;
        const auto& triangle = embree.triangles()[static_cast<std::size_t>(hit.triangle)];
        SurfacePoint point;
        point.vertices = {triangle.indices[0], triangle.indices[1], triangle.indices[2]};
        point.barycentric = {1 - static_cast<double>(hit.u) - static_cast<double>(hit.v), hit.u,
                             hit.v};
        if (transmittanceReference(scene, primitiveOf(scene, triangle), point).x == 0) return true;
        begin = std::nextafter(hit.t, 2.0F) + 1e-6F;
    }
}

std::vector<float> truth(const scene::Scene& scene, const ShadowRun& run) {
    const EmbreeScene embree(scene, run.pose, run.bounds.centre(), true);
    const auto samples = run.samplePoints();
    std::vector<float> visibility(run.pixels(), 1.0F);
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        const glm::vec3 origin = run.shadowOrigin(i), normal = run.vectorAt(GB_GEOMETRIC, i);
        int seen = 0;
        for (const auto& sample : samples)
            seen +=
                glm::dot(sample - origin, normal) > 0 && !blocked(scene, embree, origin, sample);
        visibility[i] = static_cast<float>(seen) / static_cast<float>(samples.size());
    }
    return visibility;
}

/// The floor, and a sheet over it with a cut-out texture of 7 x 5 or 4 x 8 texels.
scene::Scene cutOutSheet(Surface surface) {
    auto scene = texturedScene(3, 0, {surface});
    auto& p = scene.meshes[1].primitives[0];
    p.positions = {
        {-1.6F, 1.5F, 1.6F}, {1.6F, 1.5F, 1.6F}, {1.6F, 1.8F, -1.6F}, {-1.6F, 1.8F, -1.6F}};
    p.normals.assign(4, {0, 1, 0});
    p.colors.clear();
    for (auto& uvs : p.uvs) uvs = {{0, 0}, {1.5F, 0}, {1.5F, 1.5F}, {0, 1.5F}};
    p.indices = {0, 1, 2, 0, 2, 3};
    return scene;
}

ShadowSetup maskSetup(const char* technique) {
    ShadowSetup setup;
    setup.technique = technique;
    setup.light = kTexturedLight;
    setup.eye = {1.5, 4, 4};
    setup.samples = "32";
    return setup;
}

/// Shares of pixels wholly lit, wholly hidden and in between: a cut-out shows all three.
void expectMixed(const ShadowRun& run, const std::vector<float>& expected) {
    std::size_t lit = 0, hidden = 0, between = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i)
        if (run.tested(i)) ++(expected[i] == 1 ? lit : expected[i] == 0 ? hidden : between);
    EXPECT_GT(lit, 500U);
    EXPECT_GT(hidden, 100U);
    EXPECT_GT(between, 1000U);
}

TEST(MaskEmbree, RaysThroughCutOutTexturesAgreeRayByRay) {
    for (const auto surface : {Surface::maskNearest, Surface::maskSmooth})
        for (const bool sheet : {true, false}) {
            const auto scene = sheet ? cutOutSheet(surface) : texturedScene(5, 40, {surface});
            const auto run = runShadows(scene, maskSetup("raytrace"));
            const auto expected = truth(scene, run);
            if (sheet) expectMixed(run, expected);
            double rays = 0, different = 0;
            for (std::size_t i = 0; i < run.pixels(); ++i) {
                if (!run.tested(i)) continue;
                rays += 32;
                different += 32 * std::abs(static_cast<double>(run.visibility[i]) - expected[i]);
            }
            std::printf("[ RAYS     ] mask %d, %s: %.0f of %.0f differ from Embree\n",
                        static_cast<int>(surface), sheet ? "sheet" : "soup", different, rays);
            EXPECT_GT(rays, 100000);
            EXPECT_LE(different, 2e-5 * rays);  // rays along a texel's or a triangle's edge
        }
}

TEST(MaskEmbree, ViewWarpedShadowsOfCutOutTexturesAreAsCloseAsThoseOfGeometry) {
    for (const auto surface : {Surface::maskNearest, Surface::maskSmooth}) {
        const auto scene = cutOutSheet(surface);
        const auto run = runShadows(scene, maskSetup("vwss"));
        const auto expected = truth(scene, run);
        const double value = rmse(run, expected);
        std::printf("[ RMSE     ] cut-out sheet, mask %d: %.4f\n", static_cast<int>(surface),
                    value);
        EXPECT_LT(value, 0.012);
    }
}

}  // namespace
}  // namespace penumbra::tests
