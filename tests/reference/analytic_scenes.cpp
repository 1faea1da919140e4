// SPDX-License-Identifier: MIT
#include "tests/reference/analytic_scenes.h"

#include <algorithm>
#include <cmath>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/light_share.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/scene_builder.h"

namespace penumbra::tests {
namespace {

constexpr double kHeight = 4;  // of all lights
const char* const kSquare = "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10;name=key";
const Polygon kSquareCorners = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};

AnalyticScene withFloor(const std::string& name, const std::string& light, SceneBuilder& builder) {
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    AnalyticScene result;
    result.name = name;
    result.light = light;
    return result;
}

/// A sheet whose edge passes over the origin; it reaches from the edge away from `normal`, as far
/// as any ray from the camera's floor to the light may need.
void addHalfPlane(SceneBuilder& builder, const glm::dvec2& normal, double height) {
    const glm::vec3 away(-normal.x, 0, -normal.y), along(-normal.y, 0, normal.x);
    builder.material().doubleSided = true;
    builder.addQuad(glm::vec3(0, height, 0) - 1.5F * along, 3.0F * along, 1.5F * away);
}

/// What of the square light lies beyond the edge, seen from `point`.
Polygon beyondEdge(const Polygon& light, const glm::dvec3& point, const glm::dvec2& normal,
                   double height) {
    const glm::dvec2 edge = projected(point, {0, height, 0}, kHeight);
    return clipped(light, normal, glm::dot(normal, edge));
}

glm::dvec2 direction(double degrees) {
    const double angle = degrees * M_PI / 180;
    return {std::cos(angle), std::sin(angle)};
}

}  // namespace

std::vector<AnalyticScene> halfPlanes() {
    constexpr double kEdge = 1.5;
    std::vector<AnalyticScene> result;
    for (int turn = 0; turn < 24; ++turn) {
        const glm::dvec2 normal = direction(15 * turn);
        SceneBuilder builder;
        auto edge = withFloor("half-plane " + std::to_string(15 * turn), kSquare, builder);
        addHalfPlane(builder, normal, kEdge);
        edge.scene = builder.scene();
        edge.truth = [normal](const glm::dvec3& point) {
            return area(beyondEdge(kSquareCorners, point, normal, kEdge));
        };
        result.push_back(edge);
    }
    return result;
}

AnalyticScene sphereUnderDisk() {
    const glm::dvec3 centre(0.125, 1.5, -0.0625);
    constexpr double kRadius = 0.375, kDisk = 0.5;
    SceneBuilder builder;
    auto result =
        withFloor("sphere, disk light",
                  "disk:at=0,4,0;aim=0,0,0;up=0,0,1;radius=0.5;radiance=10;name=key", builder);
    // Facets lie within the sphere by 1.3e-4 of its radius at most
    builder.addSphere(centre, static_cast<float>(kRadius), 96, 192);
    result.scene = builder.scene();
    result.disk = true;
    result.truth = [centre](const glm::dvec3& point) {
        return diskBesideSphere(point, kDisk, kHeight, centre, kRadius);
    };
    return result;
}

AnalyticScene boxUnderRectangle() {
    const glm::dvec3 low(-0.375, 0.75, -0.25), high(0.25, 1.25, 0.3125);
    SceneBuilder builder;
    auto result =
        withFloor("box, rectangle",
                  "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1.25x0.5;radiance=10;name=key", builder);
    builder.addBox(low, high);
    result.scene = builder.scene();
    // With up = z the light's width lies along x
    const Polygon light = {{-0.625, -0.25}, {0.625, -0.25}, {0.625, 0.25}, {-0.625, 0.25}};
    result.truth = [=](const glm::dvec3& point) {
        std::vector<glm::dvec2> corners;
        for (int i = 0; i < 8; ++i)
            corners.push_back(projected(
                point, {i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z},
                kHeight));
        return 1 - commonArea(light, convexHull(corners)) / area(light);
    };
    return result;
}

AnalyticScene halfPlanesInSeries() {
    const glm::dvec2 low = direction(20), high = direction(140);
    constexpr double kLow = 1, kHigh = 2;
    SceneBuilder builder;
    auto result = withFloor("two half-planes", kSquare, builder);
    addHalfPlane(builder, low, kLow);
    addHalfPlane(builder, high, kHigh);
    result.scene = builder.scene();
    result.truth = [=](const glm::dvec3& point) {
        return area(beyondEdge(beyondEdge(kSquareCorners, point, low, kLow), point, high, kHigh));
    };
    return result;
}

AnalyticScene sheetsInSeries() {
    SceneBuilder builder;
    auto result = withFloor("six translucent sheets", kSquare, builder);
    double product = 1;
    for (int sheet = 0; sheet < 6; ++sheet) {
        const auto node = static_cast<std::size_t>(builder.addQuad(
            {-2, 1.25F + 0.25F * static_cast<float>(sheet), 2}, {4, 0, 0}, {0, 0, -4}));
        auto& scene = builder.scene();
        scene::Material veil;
        veil.alphaMode = scene::AlphaMode::blend;
        veil.baseColor = {1, 1, 1, 0.0625F * static_cast<float>(1 + sheet)};
        product *= 1 - static_cast<double>(veil.baseColor.a);
        scene.meshes[static_cast<std::size_t>(scene.nodes[node].mesh)].primitives[0].material =
            static_cast<int>(scene.materials.size());
        scene.materials.push_back(veil);
    }
    result.scene = builder.scene();
    result.truth = [product](const glm::dvec3&) { return product; };
    return result;
}

void AnalyticError::add(double truth, double measured) {
    const double error = measured - truth;
    largest = std::max(largest, std::abs(error));
    if (truth <= 0 || truth >= 1) return;
    mean += std::abs(error);
    bias += error;
    ++penumbra;
}

void AnalyticError::finish() {
    const double count = static_cast<double>(std::max<std::size_t>(penumbra, 1));
    mean /= count;
    bias /= count;
}

AnalyticError measureAnalytic(const std::vector<AnalyticScene>& scenes,
                              const std::string& technique, const std::string& samples) {
    ShadowSetup setup;
    setup.technique = technique;
    setup.samples = samples;
    setup.width = 64;
    setup.height = 48;
    // Its samples are its own, whatever the light has
    if (technique == "mvss" && samples.find('x') == std::string::npos)
        setup.settings["mvss.maps"] = samples;
    AnalyticError error;
    for (const auto& scene : scenes) {
        setup.light = scene.light;
        setup.eye = scene.eye;
        setup.target = scene.target;
        const auto run = runShadows(scene.scene, setup);
        for (std::size_t i = 0; i < run.pixels(); ++i) {
            const glm::dvec3 p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
            if (run.tested(i) && std::abs(p.y) < 1e-3) error.add(scene.truth(p), run.visibility[i]);
        }
    }
    error.finish();
    return error;
}

}  // namespace penumbra::tests
