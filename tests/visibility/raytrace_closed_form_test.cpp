// SPDX-License-Identifier: MIT
// Rays where the answer is known on paper: half-planes, a sphere, blockers in series, closed
// meshes.
#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr double kLightHeight = 4, kEdgeHeight = 1.5, kHalfSize = 0.5;

/// A square light of 1 m at height 4 over the origin, m x m samples at the centres of its cells.
ShadowSetup squareLight(const std::string& samples) {
    ShadowSetup setup;
    setup.technique = "raytrace";
    setup.light = "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10";
    setup.samples = samples;
    setup.eye = {0.2, 1.2, 2.6};
    setup.width = 64;
    setup.height = 48;
    return setup;
}

/// Area of the unit-sized light on the side of `normal` of the line normal . q = offset.
double lightBeyond(const glm::dvec2& normal, double offset) {
    std::vector<glm::dvec2> square = {{-kHalfSize, -kHalfSize},
                                      {kHalfSize, -kHalfSize},
                                      {kHalfSize, kHalfSize},
                                      {-kHalfSize, kHalfSize}};
    std::vector<glm::dvec2> kept;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto a = square[i], b = square[(i + 1) % 4];
        const double da = glm::dot(normal, a) - offset, db = glm::dot(normal, b) - offset;
        if (da > 0) kept.push_back(a);
        if ((da > 0) != (db > 0)) kept.push_back(glm::mix(a, b, da / (da - db)));
    }
    double twice = 0;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        const auto a = kept[i], b = kept[(i + 1) % kept.size()];
        twice += a.x * b.y - b.x * a.y;
    }
    return std::abs(twice) / 2;
}

/// A half-plane whose edge runs at `angle` about the vertical, 1.5 m up; it reaches from the edge
/// away from `normal`, lying flat (tilt 0) or hanging down like a wall (tilt 90).
scene::Scene halfPlane(const glm::dvec2& normal, double tilt) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    const glm::vec3 n(normal.x, 0, normal.y), along(-normal.y, 0, normal.x);
    const glm::vec3 edge(0, kEdgeHeight, 0);
    const auto c = static_cast<float>(std::cos(tilt)), s = static_cast<float>(std::sin(tilt));
    const float reach = tilt > 0 ? 1.49F / s : 9.0F;
    builder.material().doubleSided = true;
    builder.addQuad(edge - 9.0F * along, 18.0F * along, reach * (-c * n - glm::vec3(0, s, 0)));
    return builder.scene();
}

class HalfPlaneTest : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(HalfPlaneTest, ShareOfTheLightIsExactToOneRowOfSamples) {
    const auto [degrees, tilt] = GetParam();
    const double angle = degrees * M_PI / 180;
    const glm::dvec2 normal(std::cos(angle), std::sin(angle));
    constexpr int kRows = 16;
    const auto run = runShadows(halfPlane(normal, tilt * M_PI / 180), squareLight("16x16"));
    std::size_t partly = 0;
    double sum = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const glm::dvec3 p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
        const double before = glm::dot(normal, {p.x, p.z});
        if (!run.tested(i) || std::abs(p.y) > 1e-3 || (tilt > 0 && before < 0.01)) continue;
        // Seen from p, the edge lies on the light's plane at p + (edge - p) 4 / 1.5
        const double offset = before * (1 - kLightHeight / kEdgeHeight);
        const double expected = lightBeyond(normal, offset);
        EXPECT_NEAR(run.visibility[i], expected, 1.0 / kRows) << p.x << ' ' << p.z;
        sum += run.visibility[i] - expected;
        partly += expected > 0.02 && expected < 0.98;
    }
    ASSERT_GT(partly, 100U);
    // Errors of the cells on the edge cancel over many pixels; a shifted light or edge would not
    EXPECT_LT(std::abs(sum) / static_cast<double>(partly), 0.008);
}

INSTANTIATE_TEST_SUITE_P(Angles, HalfPlaneTest,
                         testing::Combine(testing::Values(0, 17, 45, 80, 118, 160),
                                          testing::Values(0, 30, 90)));

TEST(RaytraceClosedFormTest, ASphereHidesTheSamplesBehindIt) {
    constexpr int kRings = 96, kSegments = 192;
    const glm::dvec3 centre(0.1, 1.4, -0.05);
    constexpr double kRadius = 0.4F;
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addSphere(centre, static_cast<float>(kRadius), kRings, kSegments);
    const auto run = runShadows(builder.scene(), squareLight("8x8"));
    // Facets lie within the sphere, no deeper than the sagittas of a ring's and a segment's chord
    const double inner = kRadius * std::cos(M_PI / (2 * kRings)) * std::cos(M_PI / kSegments);
    const auto samples = run.samplePoints();
    std::size_t partly = 0, loose = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const glm::dvec3 from = glm::dvec3(run.shadowOrigin(i)) + run.bounds.centre();
        if (!run.tested(i) || std::abs(from.y) > 1e-3) continue;
        int least = 0, most = 0;
        for (const auto& sample : samples) {
            const glm::dvec3 to = glm::dvec3(sample) + run.bounds.centre();
            const double distance =
                glm::length(glm::cross(centre - from, to - from)) / glm::length(to - from);
            least += distance > kRadius + 1e-5;
            most += distance > inner - 1e-5;
        }
        const double seen = 64.0 * run.visibility[i];
        EXPECT_GE(seen, least - 1e-3);
        EXPECT_LE(seen, most + 1e-3);
        partly += least > 0 && least < 64;
        loose += most > least;
    }
    EXPECT_GT(partly, 300U);
    EXPECT_LT(loose, partly / 4);  // else the bounds would say nothing
}

TEST(RaytraceClosedFormTest, BlockersInSeriesLetThroughTheProduct) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    auto& scene = builder.scene();
    glm::dvec3 product(1);
    for (int sheet = 0; sheet < 6; ++sheet) {
        scene::Material glass;
        glass.alphaMode = scene::AlphaMode::blend;
        const float alpha = 0.15F + 0.07F * static_cast<float>(sheet);
        glass.baseColor = {1.0F - 0.1F * static_cast<float>(sheet), 0.5F, 0.05F, alpha};
        glass.transmission = sheet % 2 ? 0.6F : 0.0F;
        const glm::dvec3 c(glass.baseColor);
        const double a = alpha, t = glass.transmission;
        product *= sheet % 2 ? 1 - a + a * t * c : (1 - a) * (1 - a + a * c);
        const auto node = static_cast<std::size_t>(builder.addQuad(
            {-9, 0.5F + 0.4F * static_cast<float>(sheet), 9}, {18, 0, 0}, {0, 0, -18}));
        scene.meshes[static_cast<std::size_t>(scene.nodes[node].mesh)].primitives[0].material =
            static_cast<int>(scene.materials.size());
        scene.materials.push_back(glass);
    }
    const auto run = runShadows(scene, squareLight("3x3"));
    std::size_t floor = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const glm::dvec3 p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
        if (!run.tested(i) || std::abs(p.y) > 1e-3) continue;
        ++floor;
        for (std::size_t c = 0; c < 3; ++c)
            // Six logarithms and a power, each within 1/65536
            EXPECT_NEAR(run.visibility[c * run.stride + i], product[static_cast<int>(c)], 1.2e-4);
    }
    EXPECT_GT(floor, 500U);
}

TEST(RaytraceClosedFormTest, WhatLiesBeyondTheLightOrBehindTheReceiverHidesNothing) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addQuad({-9, 4.001F, 9}, {18, 0, 0}, {0, 0, -18});
    builder.addQuad({-9, -0.001F, 9}, {18, 0, 0}, {0, 0, -18});
    builder.material().doubleSided = true;
    const auto run = runShadows(builder.scene(), squareLight("8x8"));
    std::size_t floor = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const glm::dvec3 p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
        if (!run.tested(i) || std::abs(p.y) > 5e-4 || p.y < -5e-4) continue;
        EXPECT_EQ(run.visibility[i], 1) << p.x << ' ' << p.z;
        ++floor;
    }
    EXPECT_GT(floor, 500U);
}

/// A closed sphere of slivers and bumps about `centre`, cut into rings x segments; wound outwards
/// or, inside out, inwards.
void addLump(SceneBuilder& builder, const glm::vec3& centre, int rings, int segments,
             bool inwards) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> bump(1.6F, 2.4F);
    std::vector<glm::vec3> grid;
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < segments; ++s) {
            const bool pole = r == 0 || r == rings;
            if (pole && s > 0) {
                grid.push_back(grid.back());
                continue;
            }
            // Rings crowd together, so that triangles are long and thin
            const double polar = M_PI * std::pow(static_cast<double>(r) / rings, 1.5);
            const double angle = 2 * M_PI * s / segments;
            grid.push_back(centre + bump(random) * glm::vec3(std::sin(polar) * std::cos(angle),
                                                             std::cos(polar),
                                                             std::sin(polar) * std::sin(angle)));
        }
    std::vector<std::uint32_t> indices;
    const auto at = [&](int r, int s) {
        return static_cast<std::uint32_t>(r * segments + s % segments);
    };
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < segments; ++s) {
            for (const auto v : {at(r, s), at(r + 1, s), at(r + 1, s + 1)}) indices.push_back(v);
            for (const auto v : {at(r, s), at(r + 1, s + 1), at(r, s + 1)}) indices.push_back(v);
        }
    if (inwards) std::reverse(indices.begin(), indices.end());
    builder.material().doubleSided = true;
    builder.addMesh(grid, indices);
}

TEST(RaytraceClosedFormTest, NoRayLeaksOutOfAClosedMesh) {
    for (const glm::vec3 centre : {glm::vec3(0), glm::vec3(3000, -1000, 2000)})
        for (const auto& [segments, inwards] :
             {std::pair(5, true), {5, false}, {31, true}, {31, false}, {300, true}, {300, false}}) {
            SceneBuilder builder;
            builder.addQuad(centre + glm::vec3(-0.7F, 0, 0.7F), {1.4F, 0, 0}, {0, 0, -1.4F}, false);
            addLump(builder, centre, segments / 2 + 2, segments, inwards);
            auto setup = squareLight("64");
            const glm::dvec3 at(centre);
            setup.light = "rect:at=" + std::to_string(at.x) + "," + std::to_string(at.y + 4) + "," +
                          std::to_string(at.z) + ";aim=" + std::to_string(at.x) + "," +
                          std::to_string(at.y) + "," + std::to_string(at.z) +
                          ";up=0,0,1;size=1x1;radiance=10";
            setup.eye = at + glm::dvec3(0.1, 0.8, 0.3);
            setup.target = at;
            const auto run = runShadows(builder.scene(), setup);
            std::size_t tested = 0, leaks = 0;
            for (std::size_t i = 0; i < run.pixels(); ++i) {
                if (!run.tested(i)) continue;
                ++tested;
                leaks += run.visibility[i] > 0;
            }
            EXPECT_GT(tested, 1000U) << segments;
            EXPECT_EQ(leaks, 0U) << segments << " at " << centre.x;
        }
}

}  // namespace
}  // namespace penumbra::tests
