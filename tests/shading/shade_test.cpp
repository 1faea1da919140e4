// SPDX-License-Identifier: MIT
// Irradiance of area lights against numerical integration; ambient light.
#include "host/shading/shade.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "host/pipeline.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/irradiance_ref.h"
#include "tests/reference/shade_ref.h"
#include "tests/reference/shade_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

glm::dvec3 randomDirection(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3{normal(random), normal(random), normal(random)});
}

/// Receivers before the light at up to 4 m, all ways round; many see it partly below their horizon.
std::vector<Receiver> receiversOf(const scene::AreaLight& light, int count) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> aside(-2, 2), away(0.3, 4);
    std::vector<Receiver> receivers;
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 point = light.centre + aside(random) * light.axisX +
                                 aside(random) * light.axisY + away(random) * light.axisZ;
        // Half of them see the light's centre at their horizon
        glm::dvec3 normal = randomDirection(random);
        const auto towards = glm::normalize(light.centre - point);
        if (i % 2) normal = glm::normalize(normal - 0.9 * glm::dot(normal, towards) * towards);
        receivers.push_back({point, normal});
    }
    return receivers;
}

TEST(Shade, RectanglesGiveTheIntegralOverTheLight) {
    for (const glm::dvec2 size : {glm::dvec2(1, 1), glm::dvec2(2, 0.3), glm::dvec2(0.1, 0.1)}) {
        const auto light = makeLight(false, size.x, size.y);
        const auto receivers = receiversOf(light, 200);
        const auto values = irradiance(receivers, light);
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            const double expected =
                irradianceReference(light, receivers[i].point, receivers[i].normal, 200);
            EXPECT_NEAR(values[i], expected, 2e-3 * expected + 2e-4) << i << " size " << size.x;
        }
    }
}

TEST(Shade, DisksGiveTheIntegralOverTheLight) {
    for (const double size : {0.2, 1.0}) {
        const auto light = makeLight(true, size, size);
        const auto receivers = receiversOf(light, 200);
        const auto values = irradiance(receivers, light);
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            const double expected =
                irradianceReference(light, receivers[i].point, receivers[i].normal, 200);
            // A polygon of 16 corners and the same area stands for the disk
            EXPECT_NEAR(values[i], expected, 5e-3 * expected + 2e-3) << i << " size " << size;
        }
    }
}

TEST(Shade, SmallAndFarLightsFallOffWithTheSquare) {
    const auto light = makeLight(false, 0.01, 0.02);
    std::vector<Receiver> receivers;
    for (double d = 0.05; d < 2e3; d *= 1.3)
        receivers.push_back({light.centre + d * light.axisZ, -light.axisZ});
    const auto values = irradiance(receivers, light);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const double expected =
            irradianceReference(light, receivers[i].point, receivers[i].normal, 50);
        EXPECT_NEAR(values[i] / expected, 1, 0.01) << i;
    }
}

TEST(Shade, BehindTheLightAndFacingAwayNothingArrives) {
    const auto light = makeLight(false, 1, 1);
    std::mt19937 random(3);
    std::vector<Receiver> receivers;
    for (int i = 0; i < 50; ++i) {
        const auto aside = 0.5 * randomDirection(random);
        receivers.push_back({light.centre - 1.0 * light.axisZ + aside, randomDirection(random)});
        receivers.push_back({light.centre + 3.0 * light.axisZ + aside, light.axisZ});
    }
    for (const double value : irradiance(receivers, light)) EXPECT_NEAR(value, 0, 1e-6);
}

const glm::dvec3 kEye(0.7, 0.4, 2.1);

/// Random materials on receivers that the eye sees; normals are smoothed by up to 20 degrees.
std::vector<ShadePixel> pixelsOf(const scene::AreaLight& light, int count) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<ShadePixel> pixels;
    while (pixels.size() < static_cast<std::size_t>(count)) {
        ShadePixel p;
        p.position = light.centre + (4 * unit(random) - 2) * light.axisX +
                     (4 * unit(random) - 2) * light.axisY + (0.3 + 3 * unit(random)) * light.axisZ;
        const glm::dvec3 view = glm::normalize(kEye - p.position);
        // A third of the pixels lies near the mirror direction, where the lobe is high
        const auto half = glm::normalize(view + glm::normalize(light.centre - p.position));
        p.geometric = pixels.size() % 3 ? randomDirection(random)
                                        : glm::normalize(half + 0.1 * randomDirection(random));
        p.normal = glm::normalize(p.geometric + 0.35 * unit(random) * randomDirection(random));
        p.albedo = {unit(random), unit(random), unit(random)};
        p.roughness = unit(random);
        p.metallic = 1;
        if (glm::dot(p.geometric, view) > 0 && glm::dot(p.normal, view) > 0.02) pixels.push_back(p);
    }
    return pixels;
}

/// Float loses up to 1e-3 of a narrow lobe (1 - cos^2 against alpha^2 = 0.0016) and of Lambert's
/// sum (see above); a wrong power, factor or frame costs 10 % and more in most pixels.
void expectColours(const std::vector<glm::dvec3>& values, const std::vector<glm::dvec3>& expected,
                   double relative, double absolute) {
    double brightest = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            brightest = std::max(brightest, expected[i][c]);
            EXPECT_NEAR(values[i][c], expected[i][c], relative * expected[i][c] + absolute)
                << "pixel " << i << " channel " << c;
        }
    EXPECT_GT(brightest, 1000 * absolute);
}

TEST(Shade, ReflectionsAreGgxOverTheSixteenPoints) {
    for (const bool disk : {false, true})
        for (const glm::dvec2 size : {glm::dvec2(1, 1), glm::dvec2(0.3, 0.3)}) {
            auto light = makeLight(disk, size.x, disk ? size.x : 0.6 * size.y);
            light.radiance = {20, 10, 30};
            const auto pixels = pixelsOf(light, 203);
            std::vector<glm::dvec3> expected;
            for (const auto& p : pixels) {
                const bool lit =
                    shadeReference(light, p, kEye - p.position, glm::dvec3(1)) != glm::dvec3(0);
                expected.push_back(lit ? reflectionReference(light, p, kEye - p.position)
                                       : glm::dvec3(0));
            }
            expectColours(shadePixels(pixels, light, kEye, {0, 0, 0}, 1, {}), expected, 3e-3, 2e-4);
        }
}

TEST(Shade, ColourIsEmissionAmbientAndReflectanceTimesVisibility) {
    for (const int channels : {1, 3})
        for (const double outer : {0.0, 0.5}) {
            auto light = makeLight(false, 1, 0.6);
            light.radiance = {5, 4, 3};
            light.innerConeRad = 0.3;
            light.outerConeRad = outer;
            auto pixels = pixelsOf(light, 101);
            const glm::dvec3 ambient(0.1, 0.2, 0.3);
            std::mt19937 random(9);
            std::uniform_real_distribution<double> unit(0, 1);
            std::vector<glm::dvec3> seen, expected;
            for (auto& p : pixels) {
                p.metallic = unit(random);
                p.emissive = {unit(random), 0, unit(random)};
                seen.push_back({unit(random), unit(random), unit(random)});
                const auto visibility = channels == 3 ? seen.back() : glm::dvec3(seen.back().x);
                expected.push_back(p.emissive + p.albedo * ambient +
                                   shadeReference(light, p, kEye - p.position, visibility));
            }
            expectColours(shadePixels(pixels, light, kEye, ambient, channels, seen), expected, 3e-3,
                          1e-3);
        }
}

TEST(Shade, PointLightsShineByTheirIntensityInTheirCone) {
    auto light = makeLight(false, 0, 0);
    light.radiance = {8, 4, 2};
    light.innerConeRad = 0.2;
    light.outerConeRad = 0.8;
    auto pixels = pixelsOf(light, 203);
    std::vector<glm::dvec3> expected;
    for (auto& p : pixels) {
        p.metallic = 0.25;
        expected.push_back(shadeReference(light, p, kEye - p.position, glm::dvec3(1)));
    }
    expectColours(shadePixels(pixels, light, kEye, {0, 0, 0}, 1, {}), expected, 3e-3, 5e-4);
}

TEST(Shade, BlackDielectricsReflectFourPercentAndUnlitSurfacesNothing) {
    auto light = makeLight(true, 0.5, 0.5);
    light.radiance = glm::dvec3(20);
    auto pixels = pixelsOf(light, 61);
    std::vector<glm::dvec3> expected;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        pixels[i].albedo = glm::dvec3(0);
        pixels[i].metallic = 0;
        pixels[i].unlit = i % 2 != 0;
        pixels[i].emissive = glm::dvec3(0.125);
        expected.push_back(pixels[i].emissive + shadeReference(light, pixels[i],
                                                               kEye - pixels[i].position,
                                                               glm::dvec3(1)));
    }
    expectColours(shadePixels(pixels, light, kEye, {0, 0, 0}, 1, {}), expected, 3e-3, 1e-4);
}

TEST(Shade, SurfacesThatFaceAwayAreDarkHoweverTheirNormalsLean) {
    const auto light = makeLight(false, 1, 1);
    std::vector<ShadePixel> pixels;
    for (const double tilt : {-0.4, -0.1, 0.1, 0.4}) {  // the light's edge is 0.5 / 3 away
        ShadePixel p;
        p.position = light.centre + 3.0 * light.axisZ;
        p.geometric = glm::normalize(light.axisX - tilt * light.axisZ);
        p.normal = glm::normalize(light.axisX - 2.0 * light.axisZ);
        pixels.push_back(p);
    }
    const auto values =
        shadePixels(pixels, light, pixels[0].position + pixels[0].normal, {0, 0, 0}, 1, {});
    EXPECT_EQ(values[0], glm::dvec3(0));
    for (std::size_t i = 1; i < 4; ++i) EXPECT_GT(values[i].x, 0.01) << i;
}

TEST(Shade, SixteenPointsStandForTheWholeLightOnRoughSurfaces) {
    const auto light = makeLight(false, 1, 0.8);
    auto pixels = pixelsOf(light, 203);
    double sum = 0, integral = 0;
    for (auto& p : pixels) {
        p.roughness = 0.5 + 0.5 * p.roughness;  // smoother ones show the points apart from close by
        const double points = reflectionReference(light, p, kEye - p.position).x;
        const double truth = reflectionIntegral(light, p, kEye - p.position, 300).x;
        // Over many pixels they neither lose nor make light
        EXPECT_NEAR(points, truth, 0.35 * truth + 0.02) << "roughness " << p.roughness;
        sum += points;
        integral += truth;
    }
    EXPECT_NEAR(sum / integral, 1, 0.05);
}

TEST(Shade, AmbientIsFivePercentOfTheIrradianceAtTheCentre) {
    SceneBuilder builder;
    builder.material().roughness = 1;
    builder.addQuad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});  // faces +z; the light comes from behind
    auto& scene = builder.scene();
    scene.lights = {scene::parseLight("rect:at=0,0,-4;aim=0,0,0;size=1x1;radiance=20,10,5")};
    RenderOptions options;
    options.technique = "none";
    options.width = 16, options.height = 16;
    options.eye = {{0, 0, 4}};
    options.device = "cpu";
    const auto pose = scene::poseAt(scene, {}, 0);
    const auto light = scene::lightsAt(scene, pose, scene::clipBounds(scene, {}), {}).at(0);
    const double centre = irradianceReference(light, glm::dvec3(0), {0, 0, -1});
    Pipeline pipeline(options, scene);
    const auto frame = pipeline.render(0);
    const std::size_t pixel = 4 * (8 * 16 + 8);
    const double radiances[] = {20, 10, 5};
    for (std::size_t channel = 0; channel < 3; ++channel) {
        const double expected = 0.8 * 0.05 * centre * radiances[channel] / M_PI;
        EXPECT_NEAR(frame.rgba[pixel + channel] / expected, 1, 0.02);
    }
    EXPECT_EQ(frame.rgba[pixel + 3], 1);
}

}  // namespace
}  // namespace penumbra::tests
