// SPDX-License-Identifier: MIT
// Light that arrives: irradiance in closed form, and the flux through a closed surface.
#include <fmt/format.h>

#include <cmath>

#include "tests/reference/irradiance_ref.h"
#include "tests/reference/shade_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

/// A point before the light: x, y along its axes, z along its direction.
glm::dvec3 before(const scene::AreaLight& light, double x, double y, double z) {
    return light.centre + x * light.axisX + y * light.axisY + z * light.axisZ;
}

/// Largest relative difference from the closed form over a grid of parallel receivers.
double largestParallelError(const scene::AreaLight& light) {
    std::vector<Receiver> receivers;
    std::vector<double> expected;
    for (const double z : {0.1, 0.5, 1.0, 4.0})
        for (double x = -1.5; x <= 1.5; x += 0.375)
            for (double y = -1.5; y <= 1.5; y += 0.375) {
                receivers.push_back({before(light, x, y, z), -light.axisZ});
                expected.push_back(parallelIrradiance(light, {x, y}, z));
            }
    const auto values = irradiance(receivers, light);
    double largest = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        // Near 0 what counts is the share of the hemisphere
        largest = std::max(largest, std::abs(values[i] - expected[i]) / (expected[i] + 0.02));
    return largest;
}

TEST(Energy, TheClosedFormsAreTheIntegralsOverTheLight) {
    for (const bool disk : {false, true}) {
        const auto light = makeLight(disk, 0.8, disk ? 0.8 : 0.3);
        for (const glm::dvec2& offset : {glm::dvec2(0, 0), glm::dvec2(0.2, 0.1), glm::dvec2(-1, 2)})
            EXPECT_NEAR(
                parallelIrradiance(light, offset, 0.7),
                irradianceReference(light, before(light, offset.x, offset.y, 0.7), -light.axisZ),
                1e-5)
                << disk;
    }
    const auto light = makeLight(false, 0.8, 0.6);
    EXPECT_NEAR(perpendicularIrradiance(0.8, 0.6, 0.7),
                irradianceReference(light, before(light, -0.4, 0, 0.7), light.axisX), 1e-5);
}

TEST(Energy, IrradianceBelowARectangleIsTheClosedForm) {
    for (const glm::dvec2& size : {glm::dvec2(1, 1), glm::dvec2(2, 0.25), glm::dvec2(0.1, 0.1)}) {
        const auto light = makeLight(false, size.x, size.y);
        EXPECT_LT(largestParallelError(light), 1e-3) << size.x;
        std::vector<Receiver> walls;
        for (const double z : {0.25, 1.0, 3.0})
            walls.push_back({before(light, -size.x / 2, 0, z), light.axisX});
        const auto values = irradiance(walls, light);
        for (std::size_t i = 0; i < walls.size(); ++i) {
            const double z = glm::dot(walls[i].point - light.centre, light.axisZ);
            const double expected = perpendicularIrradiance(size.x, size.y, z);
            EXPECT_NEAR(values[i], expected, 2e-3 * expected + 1e-4) << size.x << " at " << z;
        }
    }
}

TEST(Energy, IrradianceBelowADiskIsTheClosedFormUpToItsSixteenCorners) {
    for (const double size : {0.1, 0.5, 1.0}) {
        const double error = largestParallelError(makeLight(true, size, size));
        std::printf("[ ENERGY   ] disk of %.1f m: at most %.4f off\n", size, error);
        // 0.1 m before the rim of a disk its corners show
        EXPECT_LT(error, 0.05) << size;
    }
}

/// Flux through a half sphere before the light, for radiance 1: receivers of equal area look at
/// its centre.
double fluxThroughHalfSphere(const scene::AreaLight& light, double radius) {
    constexpr int kPoints = 20000;
    std::vector<Receiver> receivers;
    for (int i = 0; i < kPoints; ++i) {
        const double z = (i + 0.5) / kPoints, r = std::sqrt(1 - z * z);
        const double angle = i * M_PI * (3 - std::sqrt(5.0));  // a spiral by the golden angle
        const glm::dvec3 way = before(light, r * std::cos(angle), r * std::sin(angle), z);
        const glm::dvec3 normal = light.centre - way;
        receivers.push_back({light.centre - radius * normal, normal});
    }
    double sum = 0;
    for (const double value : irradiance(receivers, light)) sum += value;
    return sum * 2 * M_PI * radius * radius / kPoints;
}

TEST(Energy, TheFluxOfALightIsItsRadianceTimesItsAreaTimesPi) {
    for (const bool disk : {false, true})
        for (const double radius : {1.0, 3.0}) {
            const auto light = makeLight(disk, 0.8, disk ? 0.8 : 0.5);
            const double area = disk ? M_PI * 0.16 : 0.4;
            const double flux = fluxThroughHalfSphere(light, radius);
            std::printf("[ ENERGY   ] flux / (radiance area pi): %.5f\n", flux / (area * M_PI));
            EXPECT_NEAR(flux / (area * M_PI), 1, 2e-3) << disk << " at " << radius;
        }
}

}  // namespace
}  // namespace penumbra::tests
