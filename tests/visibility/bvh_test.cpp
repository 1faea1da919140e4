// SPDX-License-Identifier: MIT
// The tree of boxes against its twin, on counts around the borders of leaves, nodes and levels.
#include "host/visibility/bvh.h"

#include <limits>
#include <random>

#include "tests/reference/bvh_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using U32 = std::uint32_t;

enum class Casters { all, none, some };

/// A soup of triangles about `centre`, some of them larger; with Casters::some every third draw is
/// left out.
TreeMesh soup(int count, Casters casters, const glm::vec3& centre = glm::vec3(0)) {
    std::mt19937 random(static_cast<unsigned>(count) + 1);
    std::uniform_real_distribution<float> place(-1, 1);
    TreeMesh mesh;
    for (int t = 0; t < count; ++t) {
        const glm::vec3 at{3 * place(random), place(random), 2 * place(random)};
        const float size = t % 17 == 0 ? 1.0F : 0.05F;
        for (int c = 0; c < 3; ++c)
            mesh.corners.push_back(centre + at +
                                   size * glm::vec3{place(random), place(random), place(random)});
        mesh.casts.push_back(casters == Casters::all || (casters == Casters::some && t % 3 != 1));
    }
    return mesh;
}

template <typename T>
Buffer<T> bufferOf(const char* name, const std::vector<T>& values) {
    Buffer<T> buffer(device(), name, values.size() + 1);
    buffer.upload(values);
    return buffer;
}

/// The mesh on the device: vertices in reverse order, so that indices are not the identity; draw 0
/// casts, draw 1 does not.
geometry::Mesh upload(const TreeMesh& mesh) {
    const auto vertices = mesh.corners.size();
    std::vector<float> positions(3 * vertices);
    std::vector<U32> indices, triangleDraw;
    geometry::Mesh out;
    for (std::size_t i = 0; i < vertices; ++i) {
        const std::size_t at = vertices - 1 - i;
        for (std::size_t k = 0; k < 3; ++k)
            positions[3 * at + k] = mesh.corners[i][static_cast<int>(k)];
        indices.push_back(static_cast<U32>(at));
    }
    for (const bool casts : mesh.casts) {
        triangleDraw.push_back(casts ? 0 : 1);
        out.casterTriangleCount += casts;
    }
    shared::Draw casting{}, silent{};
    casting.flags = DRAW_ANY | DRAW_CASTS;
    silent.flags = DRAW_ANY | DRAW_RECEIVES;
    out.triangleCount = static_cast<U32>(mesh.triangles());
    out.positions = bufferOf("positions", positions);
    out.indices = bufferOf("indices", indices);
    out.triangleDraw = bufferOf("draws of triangles", triangleDraw);
    out.draws = bufferOf("draws", std::vector<shared::Draw>{casting, silent});
    return out;
}

scene::Bounds boundsOf(const TreeMesh& mesh) {
    scene::Bounds bounds;
    for (const auto& corner : mesh.corners)
        if (glm::length(corner) < 1e30F) bounds.add(corner);
    return bounds;
}

class BvhCaseTest : public testing::Test {
  protected:
    /// Builds the tree of a mesh; one builder serves a test, so that its buffers are used again.
    TreeCopy build(const TreeMesh& mesh, const scene::Bounds& bounds) {
        auto uploaded = upload(mesh);
        uploaded.version = ++version_;
        bvh_.build(uploaded, bounds, bounds.centre());
        return {bvh_.params(), bvh_.nodes().download(), bvh_.leaves().download(),
                bvh_.leafTriangles().download()};
    }
    void expectSound(const TreeMesh& world, const char* what) {
        const auto bounds = boundsOf(world);
        auto rebased = world;
        for (auto& corner : rebased.corners) corner -= glm::vec3(bounds.centre());
        const auto faults = treeFaults(build(rebased, bounds), rebased);
        EXPECT_TRUE(faults.empty()) << what << ": " << faults.size()
                                    << " faults, first: " << (faults.empty() ? "" : faults[0]);
    }
    visibility::Bvh bvh_{program("frame"), program("raytrace")};
    std::uint64_t version_ = 0;
};

class BvhTest : public BvhCaseTest, public testing::WithParamInterface<int> {};

TEST_P(BvhTest, HoldsEveryCasterOnceInMortonOrderInBoxesThatContainIt) {
    expectSound(soup(GetParam(), Casters::all), "all cast");
    expectSound(soup(GetParam(), Casters::some), "some cast");
    expectSound(soup(GetParam(), Casters::none), "none casts");
    expectSound(soup(GetParam(), Casters::all, {1000, -2000, 500}), "far from the origin");
}

TEST_P(BvhTest, TrianglesThatAreNotFiniteComeLastAndSpoilNoBox) {
    auto mesh = soup(GetParam(), Casters::some);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t t = 0; t < mesh.triangles(); t += 5)
        for (std::size_t c = 0; c < 3; ++c)
            if (t % 2 == 0 || c == 1) mesh.corners[3 * t + c] = glm::vec3(nan);
    expectSound(mesh, "NaN");
}

INSTANTIATE_TEST_SUITE_P(Counts, BvhTest,
                         testing::Values(0, 1, 3, 4, 5, 8, 9, 31, 32, 33, 255, 256, 257, 2049,
                                         4097));

TEST_F(BvhCaseTest, CoincidentTrianglesKeepTheOrderOfTheMesh) {
    TreeMesh mesh;
    for (int t = 0; t < 1000; ++t) {
        const float x = t % 2 ? 0.0F : 1.0F;
        for (const auto& corner :
             {glm::vec3(x, 0, 0), glm::vec3(x, 0.1F, 0), glm::vec3(x, 0, 0.1F)})
            mesh.corners.push_back(corner);
        mesh.casts.push_back(true);
    }
    expectSound(mesh, "coincident");
}

TEST_F(BvhCaseTest, CastersBeyondTheBoundsAreClampedToTheOuterCellsAndStillHeld) {
    const auto mesh = soup(500, Casters::some);
    scene::Bounds small;
    small.add({-0.2, -0.2, -0.2});
    small.add({0.2, 0.2, 0.2});
    EXPECT_EQ(treeFaults(build(mesh, small), mesh), std::vector<std::string>{});
}

TEST_F(BvhCaseTest, AMeshThatDidNotMoveKeepsItsTree) {
    const auto mesh = soup(33, Casters::all);
    const auto bounds = boundsOf(mesh);
    const auto first = build(mesh, bounds);
    --version_;
    EXPECT_EQ(build(soup(9, Casters::all), bounds).leafTriangles, first.leafTriangles);
    EXPECT_EQ(build(soup(9, Casters::all), bounds).params.casterCount, 9);
}

}  // namespace
}  // namespace penumbra::tests
