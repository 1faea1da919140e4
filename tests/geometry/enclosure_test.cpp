// SPDX-License-Identifier: MIT
// Which closed meshes are found to have something inside.
#include "host/geometry/enclosure.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

/// Whether the first mesh, a unit sphere, encloses what `add` puts into the scene.
template <typename Add>
bool sphereEncloses(Add add, const glm::dmat4& sphere = glm::dmat4(1), bool closed = true) {
    SceneBuilder builder;
    builder.addSphere({0, 0, 0}, 1, 8, 12);
    add(builder);
    auto& scene = builder.scene();
    scene.nodes[0].matrix = sphere;
    std::vector<bool> all(scene.meshes.size(), false);
    all[0] = closed;
    return geometry::findEnclosing(scene, all).at(0);
}

TEST(Enclosure, WhatLiesInsideIsFoundAndNothingElse) {
    const auto floorAt = [](float x, bool receives) {
        return [=](SceneBuilder& b) {
            b.addQuad({x - 0.25F, 0, 0.25F}, {0.5F, 0, 0}, {0, 0, -0.5F}, false, receives);
        };
    };
    EXPECT_TRUE(sphereEncloses(floorAt(0, true)));
    EXPECT_FALSE(sphereEncloses(floorAt(0, false)));
    EXPECT_FALSE(sphereEncloses(floorAt(0, true), glm::dmat4(1), false));
    EXPECT_FALSE(sphereEncloses(floorAt(0.9F, true)));  // through the surface
    EXPECT_FALSE(sphereEncloses(floorAt(2, true)));
    EXPECT_FALSE(sphereEncloses([](SceneBuilder&) {}));
    // In a corner of the sphere's bounds, but outside of the sphere
    EXPECT_FALSE(sphereEncloses([](SceneBuilder& b) {
        b.addBox({0.75F, 0.75F, 0.75F}, {0.9F, 0.9F, 0.9F});
    }));
}

TEST(Enclosure, NodesMoveAndMirrorTheirMeshes) {
    const auto box = [](SceneBuilder& b) { b.addBox({2.5F, -0.5F, -0.5F}, {3.5F, 0.5F, 0.5F}); };
    EXPECT_FALSE(sphereEncloses(box));
    const auto moved = glm::translate(glm::dmat4(1), glm::dvec3(3, 0, 0));
    EXPECT_TRUE(sphereEncloses(box, moved));
    EXPECT_TRUE(sphereEncloses(box, glm::scale(moved, glm::dvec3(-1, 1, 1))));
}

TEST(Enclosure, AClosedSurfaceGoesRoundItsInsideOnce) {
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), d(0, 0, 1);
    const std::vector<glm::dvec3> outwards = {a, c, b, a, b, d, a, d, c, b, c, d};
    EXPECT_NEAR(geometry::windingNumber(outwards, {0.1, 0.2, 0.3}), 1, 1e-12);
    EXPECT_NEAR(geometry::windingNumber(outwards, {0.4, 0.4, 0.4}), 0, 1e-12);
    EXPECT_NEAR(geometry::windingNumber(outwards, {-3, 2, 1}), 0, 1e-12);
}

}  // namespace
}  // namespace penumbra::tests
