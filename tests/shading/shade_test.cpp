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
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

struct Receiver {
    glm::dvec3 point, normal;
};

/// A G-buffer of hand-made pixels; one row.
gbuffer::GBuffer gbufferOf(const std::vector<Receiver>& receivers, float albedo) {
    const std::size_t stride = (receivers.size() + GB_PAD - 1) / GB_PAD * GB_PAD;
    std::vector<float> planes(GB_PLANES * stride, 0.0F);
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto at = static_cast<std::size_t>(axis) * stride + i;
            planes[GB_POSITION * stride + at] = static_cast<float>(receivers[i].point[axis]);
            planes[GB_GEOMETRIC * stride + at] = static_cast<float>(receivers[i].normal[axis]);
            planes[GB_NORMAL * stride + at] = static_cast<float>(receivers[i].normal[axis]);
            planes[GB_ALBEDO * stride + at] = albedo;
        }
        planes[GB_ROUGHNESS * stride + i] = 1;
        planes[GB_OBJECT * stride + i] = std::bit_cast<float>(1U);
    }
    gbuffer::GBuffer result;
    result.width = static_cast<int>(receivers.size());
    result.height = 1;
    result.planeStride = static_cast<int>(stride);
    result.planes = runtime::Buffer<float>(device(), "G-buffer", planes);
    return result;
}

std::vector<float> shadeOnce(const std::vector<Receiver>& receivers, const scene::AreaLight& light,
                             float albedo) {
    const auto gbuffer = gbufferOf(receivers, albedo);
    shading::Shade shade(program("frame"), gbuffer.width, gbuffer.height);
    visibility::Visibility visibility;
    visibility.planes = runtime::Buffer<float>(
        device(), "visibility",
        std::vector<float>(static_cast<std::size_t>(gbuffer.planeStride), 1.0F));
    shade.begin(gbuffer, glm::dvec3(0));
    shade.add(gbuffer, light, visibility, scene::CameraFrame(), glm::dvec3(0));
    return shade.colour().download();
}

/// Irradiance for radiance 1: reflections do not depend on the albedo of a dielectric, so two
/// albedos differ by the diffuse part alone.
std::vector<double> irradiance(const std::vector<Receiver>& receivers,
                               const scene::AreaLight& light) {
    const auto bright = shadeOnce(receivers, light, 1), dim = shadeOnce(receivers, light, 0.5F);
    std::vector<double> result;
    for (std::size_t i = 0; i < receivers.size(); ++i)
        result.push_back((static_cast<double>(bright[i]) - dim[i]) * 2 * M_PI);
    return result;
}

scene::AreaLight makeLight(bool disk, double width, double height) {
    scene::AreaLight light;
    light.disk = disk;
    light.centre = {0.3, 2, -0.4};
    light.axisZ = glm::normalize(glm::dvec3(0.2, -1, 0.3));
    light.axisX = glm::normalize(glm::cross(light.axisZ, glm::dvec3(0.1, 0.2, 1)));
    light.axisY = glm::cross(light.axisZ, light.axisX);
    light.width = width;
    light.height = height;
    return light;
}

glm::dvec3 randomDirection(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
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
