// SPDX-License-Identifier: MIT
// Device posing against a twin in double, and the test for closed meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <random>

#include "host/geometry/geometry.h"
#include "host/geometry/mesh_arrays.h"
#include "tests/reference/pose_ref.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

/// Random vertices with unit normals, as one primitive of a lone node.
scene::Scene cloud(unsigned seed, std::size_t count = 99) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> at(-1, 1);
    SceneBuilder builder;
    builder.addMesh({}, {});
    auto& p = builder.scene().meshes[0].primitives[0];
    for (std::size_t i = 0; i < count; ++i) {
        p.positions.push_back({at(random), at(random), at(random)});
        p.normals.push_back(glm::normalize(glm::vec3{at(random), at(random), at(random) + 2}));
        p.indices.push_back(static_cast<std::uint32_t>(i));
    }
    return builder.scene();
}

struct Posed {
    std::vector<float> positions, normals;
    std::uint32_t nonFinite = 0;
    glm::dvec3 position(std::size_t i) const {
        return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]};
    }
    glm::dvec3 normal(std::size_t i) const {
        return {normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]};
    }
};

Posed poseOnDevice(const scene::Scene& scene, const scene::Pose& pose,
                   const glm::dvec3& centre = glm::dvec3(0)) {
    geometry::Geometry geometry(program("frame"), scene, centre);
    const auto& mesh = geometry.run(pose);
    return {mesh.positions.download(), mesh.normals.download(),
            geometry.counts().nonFiniteVertices};
}

/// Compares the first node's vertices; `tolerance` in metres.
void expectMatchesTwin(const scene::Scene& scene, double tolerance,
                       const glm::dvec3& centre = glm::dvec3(0)) {
    const auto pose = scene::poseAt(scene, {}, 0);
    const auto posed = poseOnDevice(scene, pose, centre);
    const auto& primitive = scene.meshes[0].primitives[0];
    const auto expected = poseReference(scene, pose, 0, primitive);
    double worst = 0, worstNormal = 0;
    for (std::size_t i = 0; i < primitive.positions.size(); ++i) {
        worst = std::max(worst, glm::length(posed.position(i) + centre - expected.positions[i]));
        worstNormal = std::max(worstNormal, glm::length(posed.normal(i) - expected.normals[i]));
    }
    EXPECT_LT(worst, tolerance);
    EXPECT_LT(worstNormal, 2e-5);
}

void addSkin(scene::Scene& scene, unsigned seed, const glm::dvec3& shift = glm::dvec3(0)) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    scene::Skin skin;
    for (int j = 0; j < 10; ++j) {
        scene::Node node;
        node.translation = shift + glm::dvec3{unit(random), unit(random), unit(random)};
        node.scale = glm::dvec3(0.8 + 0.4 * unit(random), 1, 1.2);
        node.rotation = glm::normalize(glm::dquat(1, 0.3 * unit(random), 0.2, 0.3 * unit(random)));
        skin.joints.push_back(static_cast<int>(scene.nodes.size()));
        skin.jointFromMesh.push_back(
            glm::translate(glm::dmat4(1), glm::dvec3{-unit(random), 0.2, unit(random)}));
        scene.order.push_back(static_cast<int>(scene.nodes.size()));
        scene.nodes.push_back(node);
    }
    scene.skins.push_back(skin);
    scene.nodes[0].skin = 0;
    auto& p = scene.meshes[0].primitives[0];
    for (std::size_t i = 0; i < p.positions.size(); ++i) {
        std::array<std::uint16_t, 8> joints{};
        std::array<float, 8> weights{};
        int left = 256;  // weights are binary fractions: their sum is 1 to the bit
        for (std::size_t k = 0; k < 8; ++k) {
            joints[k] = static_cast<std::uint16_t>(random() % 10);
            const int share = k == 7 ? left : static_cast<int>(random() % 60);
            weights[k] = static_cast<float>(std::min(share, left)) / 256;
            left -= std::min(share, left);
        }
        p.joints.push_back(joints);
        p.weights.push_back(weights);
    }
}

glm::dmat4 skewed(double mirror) {
    return glm::translate(glm::dmat4(1), glm::dvec3(1, -2, 3)) *
           glm::rotate(glm::dmat4(1), 0.7, glm::dvec3(0.3, 1, 0.2)) *
           glm::scale(glm::dmat4(1), glm::dvec3(mirror * 0.5, 3, 1.5));
}

TEST(Pose, RigidNodesMatchTheTwinForNonUniformAndNegativeScale) {
    for (const double mirror : {1.0, -1.0}) {
        auto scene = cloud(1);
        scene.nodes[0].matrix = skewed(mirror);
        expectMatchesTwin(scene, 1e-5);
    }
}

TEST(Pose, MirroringMarksTheDraw) {
    auto scene = cloud(2);
    for (const double mirror : {1.0, -1.0}) {
        scene.nodes[0].matrix = skewed(mirror);
        geometry::Geometry geometry(program("frame"), scene, glm::dvec3(0));
        const auto flags = geometry.run(scene::poseAt(scene, {}, 0)).draws.download()[0].flags;
        EXPECT_EQ((flags & DRAW_MIRRORED) != 0, mirror < 0);
    }
}

TEST(Pose, SkinsBlendEightJointsAndIgnoreTheirNode) {
    auto scene = cloud(3);
    scene.nodes[0].matrix = skewed(1);
    addSkin(scene, 3);
    expectMatchesTwin(scene, 1e-5);
}

TEST(Pose, MorphTargetsMovePositionsAndNormals) {
    auto scene = cloud(4);
    std::mt19937 random(4);
    std::uniform_real_distribution<float> at(-0.3F, 0.3F);
    auto& p = scene.meshes[0].primitives[0];
    for (int t = 0; t < 3; ++t) {
        scene::MorphTarget target;
        for (std::size_t i = 0; i < p.positions.size(); ++i) {
            if (t != 1) target.positions.push_back({at(random), at(random), at(random)});
            if (t != 2) target.normals.push_back({at(random), at(random), at(random)});
        }
        p.targets.push_back(target);
    }
    scene.meshes[0].weights = {0.5F, -0.7F, 1.4F};
    scene.nodes[0].matrix = skewed(1);
    expectMatchesTwin(scene, 1e-5);
    addSkin(scene, 5);
    expectMatchesTwin(scene, 1e-5);
}

TEST(Pose, FarFromTheOriginMillimetresSurvive) {
    const glm::dvec3 far(1e5, -3e4, 7e4);
    auto scene = cloud(6);
    scene.nodes[0].matrix = glm::translate(glm::dmat4(1), far) * skewed(1);
    expectMatchesTwin(scene, 1e-3, far);
    expectMatchesTwin(scene, 1e-5, far);
    addSkin(scene, 6, far);
    expectMatchesTwin(scene, 1e-5, far);
}

TEST(Pose, VerticesThatAreNotFiniteAreDroppedAndCounted) {
    auto scene = cloud(7);
    auto& p = scene.meshes[0].primitives[0];
    p.positions[5].x = std::numeric_limits<float>::quiet_NaN();
    p.positions[17].y = std::numeric_limits<float>::infinity();
    p.positions[40].z = 1e31F;
    const auto posed = poseOnDevice(scene, scene::poseAt(scene, {}, 0));
    EXPECT_EQ(posed.nonFinite, 3U);
    for (std::size_t i = 0; i < p.positions.size(); ++i)
        EXPECT_EQ(std::isnan(posed.position(i).x), i == 5 || i == 17 || i == 40) << i;
}

TEST(Pose, SharedMeshesArePosedOncePerNode) {
    auto scene = cloud(8, 12);
    auto second = scene.nodes[0];
    second.matrix = skewed(-1);
    scene.nodes.push_back(second);
    scene.order.push_back(1);
    const auto pose = scene::poseAt(scene, {}, 0);
    const auto posed = poseOnDevice(scene, pose);
    const auto expected = poseReference(scene, pose, 1, scene.meshes[0].primitives[0]);
    for (std::size_t i = 0; i < 12; ++i)
        EXPECT_LT(glm::length(posed.position(12 + i) - expected.positions[i]), 1e-5);
}

TEST(Pose, RemembersTheLastFramesPositions) {
    auto scene = cloud(9, 6);
    geometry::Geometry geometry(program("frame"), scene, glm::dvec3(0));
    auto pose = scene::poseAt(scene, {}, 0);
    const auto first = geometry.run(pose).positions.download();
    EXPECT_FALSE(geometry.mesh().moved);
    pose.worldFromNode[0] = skewed(1);
    const auto& mesh = geometry.run(pose);
    EXPECT_TRUE(mesh.moved);
    const auto previous = mesh.previousPositions.download(0, 18);
    EXPECT_EQ(previous, std::vector<float>(first.begin(), first.begin() + 18));
    EXPECT_FALSE(geometry.run(pose).moved);
}

using Triangles = std::vector<std::uint32_t>;

const Triangles kBoxTriangles = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};

std::vector<glm::vec3> boxCorners(glm::vec3 low, glm::vec3 high) {
    std::vector<glm::vec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y,
                             i & 4 ? high.z : low.z);
    return corners;
}

bool closed(const std::vector<glm::vec3>& positions, const Triangles& indices) {
    SceneBuilder builder;
    builder.addMesh(positions, indices);
    return geometry::isEdgeClosed(builder.scene().meshes[0]);
}

TEST(EdgeClosed, BoxesAndSpheresAreClosed) {
    EXPECT_TRUE(closed(boxCorners({0, 0, 0}, {1, 2, 3}), kBoxTriangles));
    EXPECT_TRUE(closed(boxCorners({-0.0F, 0, 0}, {1, 2, 3}), kBoxTriangles));
    SceneBuilder builder;
    builder.addSphere({1, 2, 3}, 0.7F);
    EXPECT_TRUE(geometry::isEdgeClosed(builder.scene().meshes[0]));
}

TEST(EdgeClosed, QuadsAndBoxesWithoutAFaceAreOpen) {
    EXPECT_FALSE(closed({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}));
    const auto box = boxCorners({0, 0, 0}, {1, 1, 1});
    EXPECT_FALSE(closed(box, Triangles(kBoxTriangles.begin() + 3, kBoxTriangles.end())));
    EXPECT_FALSE(closed({}, {}));
}

TEST(EdgeClosed, AFlippedTriangleOpensABox) {
    auto flipped = kBoxTriangles;
    std::swap(flipped[4], flipped[5]);
    EXPECT_FALSE(closed(boxCorners({0, 0, 0}, {1, 1, 1}), flipped));
}

TEST(EdgeClosed, TwoBoxesThatShareAnEdgeAreNotClosed) {
    auto corners = boxCorners({0, 0, 0}, {1, 1, 1});
    auto indices = kBoxTriangles;
    const auto other = boxCorners({1, 1, 0}, {2, 2, 1});
    corners.insert(corners.end(), other.begin(), other.end());
    for (const auto index : kBoxTriangles) indices.push_back(index + 8);
    EXPECT_FALSE(closed(corners, indices));
    // Two boxes apart are
    for (std::size_t i = 8; i < 16; ++i) corners[i].x += 3;
    EXPECT_TRUE(closed(corners, indices));
}

TEST(EdgeClosed, ATJunctionIsAnOpenEdge) {
    // The box's face z = 0 is split at the middle of its edge x = 0; the neighbour face is not
    auto corners = boxCorners({0, 0, 0}, {1, 1, 1});
    corners.emplace_back(0, 0.5F, 0);
    Triangles indices(kBoxTriangles.begin() + 6, kBoxTriangles.end());
    for (const std::uint32_t index : {0U, 8U, 1U, 8U, 3U, 1U, 8U, 2U, 3U}) indices.push_back(index);
    EXPECT_FALSE(closed(corners, indices));
}

}  // namespace
}  // namespace penumbra::tests
