// SPDX-License-Identifier: MIT
// The base level: every fragment that the twin finds, in order, whatever the build and the order of
// triangles.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/reference/mlsm_run.h"
#include "tests/support/fixtures.h"
#include "tests/support/textured_scene.h"

namespace penumbra::tests {
namespace {

using visibility::Faces;
using visibility::ListBuild;

MlsmSetup smallSetup() {
    MlsmSetup setup;
    setup.settings.resolution = 64;
    setup.settings.faces = Faces::all;
    return setup;
}

scene::Scene solids() {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
    builder.addSphere({-0.5F, 0.9F, 0.2F}, 0.6F, 10, 14);
    builder.addBox({-0.3F, 0.3F, -0.6F}, {1.0F, 1.1F, 0.4F});
    return builder.scene();
}

/// Random triangles between the light and the floor.
scene::Scene soup(unsigned seed, int triangles, float size) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(-1, 1);
    std::vector<glm::vec3> corners;
    std::vector<std::uint32_t> indices;
    for (int t = 0; t < triangles; ++t) {
        const glm::vec3 centre{1.2F * unit(random), 1.5F + unit(random), 1.2F * unit(random)};
        for (int i = 0; i < 3; ++i) {
            indices.push_back(static_cast<std::uint32_t>(corners.size()));
            corners.push_back(centre + size * glm::vec3{unit(random), unit(random), unit(random)});
        }
    }
    SceneBuilder builder;
    builder.addMesh(corners, indices);
    return builder.scene();
}

/// Checks lists against the twin: lengths but where an edge passes a texel's centre, then depths.
void expectTwin(const scene::Scene& scene, const MlsmSetup& setup) {
    const auto run = runMlsm(scene, setup);
    const auto twin = mlsmBaseReference(scene, run.light, run.view.params.near,
                                        run.view.params.tanHalfFov, setup.settings.resolution);
    std::size_t wrong = 0, steep = 0, fragments = 0, longest = 0;
    for (std::size_t i = 0; i < twin.size(); ++i) {
        const auto& list = run.lists[0][i];
        longest = std::max(longest, list.size());
        if (list.size() != twin[i].size()) {
            ++wrong;
            continue;
        }
        for (std::size_t f = 0; f < list.size(); ++f, ++fragments) {
            // Corners are snapped to 1/256 texel, which moves steep faces
            steep += std::abs(list[f].depth - twin[i][f].depth) > 5e-5;
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(list[f].taken[c], twin[i][f].taken[c], 1e-6) << "texel " << i;
        }
    }
    std::printf("[ LISTS    ] %zu fragments, longest list %zu, %zu of %zu lists differ\n",
                fragments, longest, wrong, twin.size());
    EXPECT_GT(fragments, 300U);
    EXPECT_LE(wrong, twin.size() / 100);
    EXPECT_LE(steep, fragments / 12);
}

TEST(MlsmListsTest, HoldAllFragmentsOfTheTwinInOrder) {
    expectTwin(solids(), smallSetup());
    expectTwin(soup(1, 60, 0.5F), smallSetup());
}

TEST(MlsmListsTest, HoldWhatBlendedSurfacesTakeOfEachChannel) {
    auto scene = solids();
    scene.materials[0].alphaMode = scene::AlphaMode::blend;
    scene.materials[0].baseColor = {0.9F, 0.5F, 0.2F, 0.6F};
    expectTwin(scene, smallSetup());
    scene.materials[0].alphaMode = scene::AlphaMode::opaque;
    scene.materials[0].transmission = 0.8F;
    expectTwin(scene, smallSetup());
}

TEST(MlsmListsTest, BothBuildsAndPermutedTrianglesGiveTheSameBits) {
    for (const bool coloured : {false, true}) {
        auto scene = coloured ? texturedScene(3, 40,
                                              {Surface::opaque, Surface::maskSmooth,
                                               Surface::blendTexture, Surface::glass})
                              : soup(2, 200, 0.3F);
        auto setup = smallSetup();
        const auto array = runMlsm(scene, setup);
        setup.settings.build = ListBuild::list;
        EXPECT_TRUE(sameLists(array, runMlsm(scene, setup)));
        std::mt19937 random(5);
        for (auto& mesh : scene.meshes)
            for (auto& p : mesh.primitives)
                for (std::size_t t = p.indices.size() / 3 - 1; t > 0; --t) {
                    const std::size_t other = random() % (t + 1);
                    for (std::size_t c = 0; c < 3; ++c)
                        std::swap(p.indices[3 * t + c], p.indices[3 * other + c]);
                }
        EXPECT_TRUE(sameLists(array, runMlsm(scene, setup)));
        setup.settings.build = ListBuild::array;
        EXPECT_TRUE(sameLists(array, runMlsm(scene, setup)));
    }
}

TEST(MlsmListsTest, SurfacesAtTheSameDepthAreInTheOrderOfTheirOpacity) {
    const auto panes = [](bool swapped) {
        SceneBuilder builder;
        builder.addQuad({-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
        builder.addQuad({-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
        auto& scene = builder.scene();
        scene.materials[0].alphaMode = scene::AlphaMode::blend;
        scene.materials.push_back(scene.materials[0]);
        scene.materials[0].baseColor.w = 0.3F;
        scene.materials[1].baseColor.w = 0.7F;
        scene.meshes[swapped ? 0 : 1].primitives[0].material = 1;
        return scene;
    };
    const auto first = runMlsm(panes(false), smallSetup()),
               second = runMlsm(panes(true), smallSetup());
    EXPECT_EQ(first.lists[0][32 * 64 + 32].size(), 2U);
    EXPECT_TRUE(sameLists(first, second));
}

TEST(MlsmListsTest, ListsOfThousandsGrowAndAreSorted) {
    auto setup = smallSetup();
    setup.settings.maxLevel = 0;
    for (const auto build : {ListBuild::array, ListBuild::list}) {
        setup.settings.build = build;
        const auto run = runMlsm(soup(4, 40000, 1.0F), setup);
        EXPECT_GT(run.retries, 0) << "the first capacity must not do, to see the lists grow";
        std::size_t longest = 0;
        for (const auto& list : run.lists[0]) {
            longest = std::max(longest, list.size());
            EXPECT_TRUE(std::is_sorted(list.begin(), list.end(), [](const auto& a, const auto& b) {
                return a.depth > b.depth;
            }));
        }
        EXPECT_GT(longest, 1000U);
    }
}

TEST(MlsmListsTest, LayersKeepTheFirstOnesAndJoinMergesWhatIsClose) {
    auto setup = smallSetup();
    const auto all = runMlsm(soup(1, 60, 0.5F), setup);
    setup.settings.layers = 2;
    const auto two = runMlsm(soup(1, 60, 0.5F), setup);
    setup.settings.layers = 0;
    setup.settings.join = true;
    setup.settings.epsilon = 8;
    const auto joined = runMlsm(soup(1, 60, 0.5F), setup);
    std::size_t cut = 0, fewer = 0;
    const double epsilon = 8 / static_cast<double>(all.view.params.focal);
    for (std::size_t i = 0; i < all.lists[0].size(); ++i) {
        const auto& list = all.lists[0][i];
        ASSERT_EQ(two.lists[0][i].size(), std::min<std::size_t>(list.size(), 2));
        cut += list.size() > 2;
        for (std::size_t f = 0; f < two.lists[0][i].size(); ++f)
            EXPECT_EQ(two.lists[0][i][f].depth, list[f].depth);
        double sum = 0, joinedSum = 0;
        for (const auto& f : list) sum += f.coverage;
        const auto& short_ = joined.lists[0][i];
        for (const auto& f : short_) joinedSum += f.coverage;
        EXPECT_NEAR(joinedSum, sum, 1e-4);
        fewer += short_.size() < list.size();
        for (std::size_t f = 1; f < short_.size(); ++f)
            EXPECT_LT(short_[f].depth, short_[f - 1].depth * (1 - 0.4 * epsilon));
    }
    EXPECT_GT(cut, 15U);
    EXPECT_GT(fewer, 50U);
}

TEST(MlsmListsTest, FacesKeepTheBackOfClosedSolidsAndBothSidesOfSheetsAndGlass) {
    SceneBuilder builder;
    builder.addSphere({0, 1, 0}, 0.6F, 24, 32);
    auto setup = smallSetup();
    const auto lengths = [&](Faces faces) {
        setup.settings.faces = faces;
        const auto run = runMlsm(builder.scene(), setup);
        std::size_t longest = 0;
        double front = 0;
        for (const auto& list : run.lists[0]) {
            longest = std::max(longest, list.size());
            if (!list.empty()) front = std::max(front, list[0].depth);
        }
        return std::pair(longest, front);
    };
    const auto all = lengths(Faces::all), back = lengths(Faces::back),
               front = lengths(Faces::front), automatic = lengths(Faces::automatic);
    EXPECT_EQ(all.first, 2U);
    EXPECT_EQ(back.first, 1U);
    EXPECT_EQ(front.first, 1U);
    EXPECT_EQ(automatic, back);
    EXPECT_EQ(front.second, all.second);
    EXPECT_LT(back.second, front.second);
    builder.material().alphaMode = scene::AlphaMode::blend;
    EXPECT_EQ(lengths(Faces::automatic).first, 2U) << "a closed glass counts twice";
}

TEST(MlsmListsTest, MinifiedAlphaTestsCoverByTheShareThatPasses) {
    // Stripes, a third of them solid, finer than the light's texels
    SceneBuilder builder;
    builder.addQuad({-1, 1, 1}, {2, 0, 0}, {0, 0, -2});
    auto& scene = builder.scene();
    scene::Image stripes;
    stripes.width = stripes.height = 48;
    for (int i = 0; i < 48 * 48; ++i)
        for (const int value : {255, 255, 255, i % 3 == 0 ? 153 : 102})
            stripes.texels.push_back(static_cast<std::uint8_t>(value));
    scene.images.push_back(stripes);
    scene.materials[0].alphaMode = scene::AlphaMode::mask;
    scene.materials[0].baseColorTexture.image = 0;
    auto& p = scene.meshes[0].primitives[0];
    for (const auto& position : p.positions) p.uvs[0].emplace_back(8 * position.x, 8 * position.z);
    const auto run = runMlsm(scene, smallSetup());
    double sum = 0;
    std::size_t covered = 0;
    for (const auto& list : run.lists[0])
        for (const auto& f : list) {
            EXPECT_GE(f.coverage, 0);
            EXPECT_LE(f.coverage, 1);
            sum += f.coverage;
            ++covered;
        }
    ASSERT_GT(covered, 200U);
    EXPECT_NEAR(sum / static_cast<double>(covered), 1.0 / 3, 0.02);
}

}  // namespace
}  // namespace penumbra::tests
