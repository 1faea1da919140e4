// SPDX-License-Identifier: MIT
// Lists of blended fragments: complete, in exact depth order, in front of the opaque surface,
// whatever the order of triangles; and their entries in the G-buffer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

#include "host/gbuffer/gbuffer.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/abuffer_ref.h"
#include "tests/reference/gbuffer_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr std::pair<int, int> kSizes[] = {{7, 5}, {33, 17}, {61, 37}, {131, 71}};

scene::CameraFrame frontCamera() {
    return perspectiveCamera({0.2, 0.1, 4}, {0, 0, 0}, 50);
}

int addMaterial(scene::Scene& scene, const scene::Material& material) {
    scene.materials.push_back(material);
    return static_cast<int>(scene.materials.size()) - 1;
}

scene::Primitive& primitiveOf(scene::Scene& scene, int node) {
    const auto mesh = static_cast<std::size_t>(scene.nodes[static_cast<std::size_t>(node)].mesh);
    return scene.meshes[mesh].primitives[0];
}

scene::Material blendMaterial(const glm::vec4& colour) {
    scene::Material m;
    m.metallic = 0;
    m.doubleSided = true;
    m.alphaMode = scene::AlphaMode::blend;
    m.baseColor = colour;
    return m;
}

/// An image of smooth alphas, 0 and 255 among them, so that neighbouring uvs have near values.
scene::Image ramps() {
    scene::Image image{16, 16, {}};
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            for (const int value : {20 * x % 256, 128, 15 * y, std::clamp(24 * x - 60, 0, 255)})
                image.texels.push_back(static_cast<std::uint8_t>(value));
    return image;
}

/// Triangles of a node each, large and small: blended, blended by a texture, transmitting, opaque.
scene::Scene mixedTriangles(unsigned seed, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-2, 2), deep(-5, 2.5F), small(-0.2F, 0.2F), uv(0, 1);
    SceneBuilder builder;
    auto& scene = builder.scene();
    builder.material().doubleSided = true;
    scene.images.push_back(ramps());
    auto textured = blendMaterial({1, 1, 1, 1});
    textured.baseColorTexture.image = 0;
    textured.baseColorTexture.wrapU = textured.baseColorTexture.wrapV = scene::Wrap::clamp;
    auto glass = blendMaterial({0.9F, 0.5F, 0.2F, 1});
    glass.alphaMode = scene::AlphaMode::opaque;
    glass.transmission = 0.75F;
    auto tinted = blendMaterial({0.3F, 0.8F, 0.6F, 0.5F});
    tinted.transmission = 0.5F;
    const int kinds[] = {addMaterial(scene, blendMaterial({0.8F, 0.2F, 0.1F, 0.4F})),
                         addMaterial(scene, textured), addMaterial(scene, glass),
                         addMaterial(scene, tinted)};
    for (int i = 0; i < count; ++i) {
        const glm::vec3 first{at(random), at(random), deep(random)};
        std::vector<glm::vec3> corners{first};
        for (int c = 0; c < 2; ++c)
            corners.push_back(i % 3
                                  ? glm::vec3{at(random), at(random), deep(random)}
                                  : first + glm::vec3{small(random), small(random), small(random)});
        const int node = builder.addMesh(corners, {0, 1, 2});
        auto& p = primitiveOf(scene, node);
        p.material = i % 10 == 9 ? 0 : kinds[i % 4];
        for (std::size_t v = 0; v < p.positions.size(); ++v)
            p.uvs[0].push_back({uv(random), uv(random)});
    }
    return scene;
}

struct ListDifference {
    int missing = 0, surplus = 0, disordered = 0, wrongValue = 0, listed = 0;
};

void compareList(const std::vector<ListedFragment>& mine, const std::vector<BlendedFragment>& twin,
                 ListDifference& d) {
    const auto find = [](const auto& list, int triangle) {
        return std::find_if(list.begin(), list.end(),
                            [&](const auto& f) { return f.triangle == triangle; });
    };
    double last = 1e300;
    for (const auto& f : mine) {
        ++d.listed;
        d.disordered += f.depth > last;
        last = f.depth;
        const auto same = find(twin, f.triangle);
        if (same == twin.end()) {
            ++d.surplus;
            continue;
        }
        d.wrongValue += std::abs(f.depth - same->depth) > same->slack ||
                        std::abs(f.alpha - same->alpha) > 6e-3 ||
                        glm::length(f.through - same->through) > 1e-2;
    }
    for (const auto& f : twin) d.missing += !f.doubtful && find(mine, f.triangle) == mine.end();
}

ListDifference compareLists(const GBufferRun& run, const ABufferReference& twin) {
    ListDifference d;
    for (int y = 0; y < run.height; ++y)
        for (int x = 0; x < run.width; ++x)
            compareList(run.lists[run.at(x, y)], twin.list(x, y), d);
    return d;
}

TEST(ABuffer, ListsHoldWhatTheTwinSeesBeforeTheOpaqueSurface) {
    const auto camera = frontCamera();
    for (const auto& [width, height] : kSizes)
        for (unsigned seed = 0; seed < 3; ++seed) {
            const auto scene = mixedTriangles(seed, 120);
            const auto run = runGBuffer(scene, camera, width, height);
            const auto d = compareLists(run, {scene, camera, width, height});
            // A vertex that float snaps to the other neighbour moves an edge over a centre; a
            // texture's level is read off a footprint that is just a power of two
            EXPECT_LE(d.missing, d.listed / 1000 + 1) << width << " x " << height;
            EXPECT_LE(d.surplus, d.listed / 1000 + 1);
            EXPECT_LE(d.wrongValue, d.listed / 100 + 1);
            EXPECT_EQ(d.disordered, 0);
            EXPECT_GT(d.listed, width * height);
        }
}

TEST(ABuffer, BothDepthPathsGiveTheSameBytes) {
    const auto scene = mixedTriangles(4, 150);
    const auto wide = runGBuffer(scene, frontCamera(), 61, 37);
    const auto narrow = runGBuffer(scene, frontCamera(), 61, 37, glm::dvec3(0), false);
    ASSERT_EQ(wide.planes.size(), narrow.planes.size());
    EXPECT_EQ(
        std::memcmp(wide.planes.data(), narrow.planes.data(), wide.planes.size() * sizeof(float)),
        0);
}

TEST(ABuffer, InterpenetratingQuadsAreSortedAtEachPixel) {
    // Planes through one another about the screen's centre, at depths z = sx x + sy y + z0
    std::mt19937 random(5);
    std::uniform_real_distribution<float> slope(-0.4F, 0.4F), offset(-0.4F, 0.4F);
    SceneBuilder builder;
    builder.material() = blendMaterial({1, 1, 1, 0.5F});
    std::vector<glm::dvec3> planes;
    for (int i = 0; i < 12; ++i) {
        const glm::vec3 p{slope(random), slope(random), offset(random)};
        builder.addQuad({-4, -4, p.z - 4 * p.x - 4 * p.y}, {8, 0, 8 * p.x}, {0, 8, 8 * p.y});
        planes.emplace_back(p);
    }
    const auto camera = perspectiveCamera({0, 0, 4}, {0, 0, 0}, 30);
    const auto run = runGBuffer(builder.scene(), camera, 131, 71);
    int swaps = 0, compared = 0;
    std::vector<int> firstOrder;
    for (int y = 0; y < run.height; ++y)
        for (int x = 0; x < run.width; ++x) {
            const auto& list = run.lists[run.at(x, y)];
            ASSERT_EQ(list.size(), planes.size());
            const glm::dvec3 ray = pixelRay(camera, run.width, run.height, x, y);
            // 4 - t = z = sx t rx + sy t ry + z0
            const auto distance = [&](int quad) {
                const auto& p = planes[static_cast<std::size_t>(quad)];
                return (4 - p.z) / (1 + p.x * ray.x + p.y * ray.y);
            };
            std::vector<int> order;
            for (const auto& f : list) order.push_back(f.triangle / 2);
            for (std::size_t i = 0; i + 1 < order.size(); ++i) {
                const double nearer = distance(order[i]), farther = distance(order[i + 1]);
                // Float depth resolves 1e-6 of the distance; snapped corners 1e-4
                EXPECT_LT(nearer, farther + 2e-4) << x << ',' << y;
                ++compared;
            }
            if (firstOrder.empty()) firstOrder = order;
            swaps += order != firstOrder;
        }
    EXPECT_GT(swaps, run.width * run.height / 2);
    EXPECT_EQ(compared, 11 * run.width * run.height);
}

/// All triangles of `scene` in one mesh per material, in the order that `random` gives.
scene::Scene shuffled(const scene::Scene& scene, unsigned seed) {
    auto result = scene;
    std::mt19937 random(seed);
    for (auto& mesh : result.meshes) {
        auto& p = mesh.primitives[0];
        std::vector<std::size_t> order(p.indices.size() / 3);
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::shuffle(order.begin(), order.end(), random);
        std::vector<std::uint32_t> indices;
        for (const auto t : order)
            for (std::size_t c = 0; c < 3; ++c) indices.push_back(p.indices[3 * t + c]);
        p.indices = indices;
    }
    return result;
}

TEST(ABuffer, PermutedTrianglesChangeNoByte) {
    // Coplanar overlapping triangles of different colours: all depths are equal
    SceneBuilder builder;
    builder.material() = blendMaterial({1, 1, 1, 0.5F});
    std::mt19937 random(9);
    std::uniform_real_distribution<float> at(-1.5F, 1.5F);
    std::vector<glm::vec3> corners;
    std::vector<std::uint32_t> indices;
    for (int i = 0; i < 160; ++i)
        for (int c = 0; c < 3; ++c) {
            indices.push_back(static_cast<std::uint32_t>(corners.size()));
            corners.push_back({at(random), at(random), i % 3 ? 0.0F : at(random)});
        }
    builder.addMesh(corners, indices);
    auto& p = builder.scene().meshes[0].primitives[0];
    for (std::size_t i = 0; i < p.positions.size(); ++i)
        p.colors.emplace_back(static_cast<float>(i / 3) / 160, 0.5F, 0.2F, 1);
    const auto first = runGBuffer(builder.scene(), frontCamera(), 61, 37);
    int ties = 0;
    for (const auto& list : first.lists)
        for (std::size_t i = 0; i + 1 < list.size(); ++i)
            ties += list[i].depth == list[i + 1].depth;
    EXPECT_GT(ties, 1000);
    for (unsigned seed = 1; seed < 4; ++seed) {
        const auto other = runGBuffer(shuffled(builder.scene(), seed), frontCamera(), 61, 37);
        ASSERT_EQ(other.planes.size(), first.planes.size());
        EXPECT_EQ(std::memcmp(other.planes.data(), first.planes.data(),
                              first.planes.size() * sizeof(float)),
                  0);
    }
}

TEST(ABuffer, AThousandLayersAtOnePixelAreAllThere) {
    SceneBuilder builder;
    builder.material() = blendMaterial({1, 1, 1, 0.01F});
    std::vector<int> order(1000);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(2));
    // A pixel's stack among pixels of few layers, for pixelCamera(): (x, -y, z)
    for (const int i : order)
        builder.addQuad({4, -4, 0.004F * static_cast<float>(i)}, {1, 0, 0}, {0, 1, 0});
    builder.addQuad({0, -7, 5}, {9, 0, 0}, {0, 7, 0});
    const auto run = runGBuffer(builder.scene(), pixelCamera(9, 7), 9, 7);
    EXPECT_GT(run.repetitions, 0);
    EXPECT_EQ(run.layers, 1001U);
    for (int y = 0; y < 7; ++y)
        for (int x = 0; x < 9; ++x) {
            const auto& list = run.lists[run.at(x, y)];
            ASSERT_EQ(list.size(), x == 4 && y == 3 ? 1001U : 1U);
            for (std::size_t i = 1; i < list.size(); ++i) {
                // From the nearest (largest z) to the farthest, and none twice
                const int quad = list[i].triangle / 2;
                ASSERT_EQ(order[static_cast<std::size_t>(quad)], 1000 - static_cast<int>(i));
                ASSERT_NEAR(run.planes[GB_DEPTH * run.stride + list[i].entry],
                            10 - 0.004 * (1000 - static_cast<double>(i)), 1e-4);
            }
        }
}

TEST(ABuffer, LongAndShortListsAreSortedAlike) {
    // Lists of 1 to 80 fragments, one length a pixel: both ways of sorting, and their border
    constexpr int kLongest = 80;
    SceneBuilder builder;
    builder.material() = blendMaterial({1, 1, 1, 0.3F});
    std::vector<int> order(kLongest);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(3));
    for (const int i : order)
        builder.addQuad({static_cast<float>(i), -1, 0.05F * static_cast<float>(i * 37 % kLongest)},
                        {static_cast<float>(kLongest - i), 0, 0}, {0, 1, 0});
    const auto run = runGBuffer(builder.scene(), pixelCamera(kLongest, 1), kLongest, 1);
    for (int x = 0; x < kLongest; ++x) {
        const auto& list = run.lists[run.at(x, 0)];
        ASSERT_EQ(list.size(), static_cast<std::size_t>(x + 1));
        for (std::size_t i = 0; i + 1 < list.size(); ++i)
            ASSERT_GT(list[i].depth, list[i + 1].depth) << x;
    }
}

TEST(ABuffer, OnlyWhatIsNotBehindTheOpaqueSurfaceIsListed) {
    SceneBuilder builder;
    auto& scene = builder.scene();
    const int blend = addMaterial(scene, blendMaterial({1, 1, 1, 0.5F}));
    for (const float z : {1.0F, 2.0F, 3.0F}) {
        const int node = builder.addQuad({0, -5, z}, {7, 0, 0}, {0, 5, 0});
        if (z != 2) primitiveOf(scene, node).material = blend;
    }
    // A coat on the opaque surface: its very corners
    primitiveOf(scene, builder.addQuad({0, -5, 2}, {7, 0, 0}, {0, 5, 0})).material = blend;
    const auto run = runGBuffer(scene, pixelCamera(7, 5), 7, 5);
    for (const auto& list : run.lists) {
        ASSERT_EQ(list.size(), 2U);
        EXPECT_EQ(list[0].triangle / 2, 2);
        EXPECT_EQ(list[1].triangle / 2, 3);
    }
    EXPECT_EQ(run.object(3, 2), 2U);
}

TEST(ABuffer, AlphaOfATextureMakesOpaqueBlendedOrNothing) {
    // Texels of alpha 255, 128 and 0, three pixels wide each
    SceneBuilder builder;
    auto& scene = builder.scene();
    builder.material() = blendMaterial({1, 1, 1, 1});
    scene.images.push_back({3, 1, {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0}});
    builder.material().baseColorTexture.image = 0;
    builder.material().baseColorTexture.nearest = true;
    const int node = builder.addQuad({0, -3, 0}, {9, 0, 0}, {0, 3, 0});
    for (const auto& p : primitiveOf(scene, node).positions)
        primitiveOf(scene, node).uvs[0].emplace_back(p.x / 9, -p.y / 3);
    for (const bool wide : {true, false}) {
        const auto run = runGBuffer(scene, pixelCamera(9, 3), 9, 3, glm::dvec3(0), wide);
        for (int y = 0; y < 3; ++y)
            for (int x = 0; x < 9; ++x) {
                EXPECT_EQ(run.object(x, y), x < 3 ? 1U : 0U) << x;
                const auto& list = run.lists[run.at(x, y)];
                ASSERT_EQ(list.size(), x >= 3 && x < 6 ? 1U : 0U) << x;
                for (const auto& f : list) EXPECT_NEAR(f.alpha, 128.0 / 255, 1e-6);
            }
        EXPECT_NEAR(run.vector(GB_ALBEDO, 1, 1).x, 1, 1e-6);
    }
}

TEST(ABuffer, AMaskIsOpaqueOrNothingAlsoWhereItTransmits) {
    SceneBuilder builder;
    builder.material() = blendMaterial({1, 1, 1, 0.6F});
    builder.material().alphaMode = scene::AlphaMode::mask;
    builder.material().transmission = 1;
    builder.addQuad({0, -3, 0}, {5, 0, 0}, {0, 3, 0});
    const auto run = runGBuffer(builder.scene(), pixelCamera(5, 3), 5, 3);
    EXPECT_EQ(run.object(2, 1), 1U);
    for (const auto& list : run.lists) EXPECT_TRUE(list.empty());
}

TEST(ABuffer, EntriesOfFragmentsAreWhatOpaqueSurfacesWouldShow) {
    // One surface at a time, once blended and once opaque; nodes 1, 4 and 5 do not transmit
    const auto camera = frontCamera();
    std::size_t compared = 0;
    for (unsigned seed = 0; seed < 6; ++seed)
        for (const int node : {1, 4, 5}) {
            auto scene = mixedTriangles(seed + 20, 6);
            scene.order = {node};
            const auto run = runGBuffer(scene, camera, 61, 37);
            scene.materials[static_cast<std::size_t>(primitiveOf(scene, node).material)].alphaMode =
                scene::AlphaMode::opaque;
            const auto opaque = runGBuffer(scene, camera, 61, 37);
            for (std::size_t pixel = 0; pixel < run.lists.size(); ++pixel)
                for (const auto& f : run.lists[pixel])
                    for (std::size_t plane = 0; plane < GB_PLANES; ++plane) {
                        if (plane == GB_FLAGS) continue;
                        const float a = run.planes[plane * run.stride + f.entry],
                                    b = opaque.planes[plane * opaque.stride + pixel];
                        ASSERT_EQ(std::memcmp(&a, &b, sizeof a), 0) << plane;
                        ++compared;
                    }
        }
    EXPECT_GT(compared, 20000U);
}

TEST(ABuffer, WhatIsTransmittedIsNotReflected) {
    SceneBuilder builder;
    builder.material() = blendMaterial({0.8F, 0.4F, 0.2F, 0.5F});
    builder.material().transmission = 0.75F;
    builder.addQuad({0, -3, 0}, {5, 0, 0}, {0, 3, 0});
    const auto run = runGBuffer(builder.scene(), pixelCamera(5, 3), 5, 3);
    const auto& f = run.lists[7].at(0);
    EXPECT_NEAR(f.alpha, 0.5, 1e-7);
    // T = (1 - a) + a t c
    EXPECT_NEAR(f.through.x, 0.5 + 0.5 * 0.75 * 0.8, 1e-6);
    EXPECT_NEAR(f.through.y, 0.5 + 0.5 * 0.75 * 0.4, 1e-6);
    EXPECT_NEAR(f.through.z, 0.5 + 0.5 * 0.75 * 0.2, 1e-6);
    EXPECT_NEAR(run.planes[GB_ALBEDO * run.stride + f.entry], 0.8 * 0.25, 1e-6);
}

TEST(ABuffer, WithoutBlendedSurfacesThereAreNoFurtherRows) {
    SceneBuilder builder;
    builder.addQuad({0, -3, 0}, {5, 0, 0}, {0, 3, 0});
    const auto run = runGBuffer(builder.scene(), pixelCamera(5, 3), 5, 3);
    EXPECT_TRUE(run.lists.empty());
    EXPECT_EQ(run.stride, static_cast<std::size_t>(shared::gbufferStride(5 * 3)));
}

}  // namespace
}  // namespace penumbra::tests
