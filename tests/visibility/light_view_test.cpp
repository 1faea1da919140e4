// SPDX-License-Identifier: MIT
// The fit of a light's views, and the two multiply-adds a view against full matrices in double.
#include "host/visibility/light_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using visibility::fitLightView;
using visibility::LightView;

scene::Bounds boundsOf(const glm::dvec3& low, const glm::dvec3& high) {
    scene::Bounds bounds;
    bounds.add(low);
    bounds.add(high);
    return bounds;
}

scene::AreaLight lightOf(const std::string& text, const scene::Bounds& bounds,
                         const std::string& samples = "16") {
    scene::Scene scene;
    scene.lights = {scene::parseLight(text)};
    return scene::lightsAt(scene, {}, bounds, scene::parseSampleCount(samples, {})).at(0);
}

/// Pixel coordinates and reversed depth of a world point in the view of one sample, by a full
/// matrix: look along the light's axis from the sample, then a symmetric projection.
glm::dvec3 byMatrix(const scene::AreaLight& light, const LightView& view, const glm::dvec2& sample,
                    const glm::dvec3& world) {
    const glm::dvec3 eye = light.centre + sample.x * light.axisX + sample.y * light.axisY;
    const glm::dmat4 worldFromView(glm::dvec4(light.axisX, 0), glm::dvec4(light.axisY, 0),
                                   glm::dvec4(light.axisZ, 0), glm::dvec4(eye, 1));
    const double t = view.params.tanHalfFov, near = view.params.near;
    glm::dmat4 clipFromView(0);
    clipFromView[0][0] = clipFromView[1][1] = 1 / t;
    clipFromView[3][2] = near;  // z' = near
    clipFromView[2][3] = 1;     // w' = z
    const glm::dvec4 clip = clipFromView * glm::inverse(worldFromView) * glm::dvec4(world, 1);
    const double half = 0.5 * view.params.resolution;
    return {half * (1 + clip.x / clip.w), half * (1 + clip.y / clip.w), clip.z / clip.w};
}

glm::vec3 lightSpace(const LightView& view, const glm::vec3& p) {
    glm::vec3 result;
    for (int i = 0; i < 3; ++i) {
        const auto& r = view.params.lightFromWorld.row[i];
        result[i] = r.x * p.x + r.y * p.y + r.z * p.z + r.w;
    }
    return result;
}

const scene::Bounds kBox = boundsOf({-1, 0, -0.5}, {1.5, 2, 0.75});

TEST(LightView, TwoMultiplyAddsPerViewEqualTheFullMatrix) {
    for (const glm::dvec3 shift : {glm::dvec3(0), glm::dvec3(1e5, -2e4, 3e4)}) {
        const auto bounds = boundsOf(kBox.low + shift, kBox.high + shift);
        auto light = lightOf("rect:at=2,5,3;aim=0,1,0;size=1.5x0.7", kBox);
        light.centre += shift;
        const auto view = fitLightView(light, bounds, bounds.centre(), 1024, 1);
        const auto& p = view.params;
        std::mt19937 random(1);
        std::uniform_real_distribution<double> unit(0, 1);
        double worst = 0, worstDepth = 0;
        for (int i = 0; i < 100000; ++i) {
            const glm::dvec3 share{unit(random), unit(random), unit(random)};
            const glm::vec3 rebased(glm::mix(bounds.low, bounds.high, share) - bounds.centre());
            const auto s = static_cast<std::size_t>(i) % light.samples.size();
            const glm::vec3 q = lightSpace(view, rebased);
            const float w = p.near / q.z;
            const float u = p.focal * q.x / q.z + p.centre - view.samples[2 * s] * w;
            const float v = p.focal * q.y / q.z + p.centre - view.samples[2 * s + 1] * w;
            const auto expected =
                byMatrix(light, view, light.samples[s], glm::dvec3(rebased) + bounds.centre());
            worst = std::max({worst, std::abs(u - expected.x), std::abs(v - expected.y)});
            worstDepth = std::max(worstDepth, std::abs(w - expected.z));
        }
        EXPECT_LT(worst, 1e-3);
        EXPECT_LT(worstDepth, 1e-6);
    }
}

TEST(LightView, EveryCasterLiesInEveryViewAndOneNearlyTouchesItsBorder) {
    for (const char* text :
         {"rect:at=2,5,3;aim=0,1,0;size=1.5x0.7", "disk:at=0,6,0;aim=0,0,0;radius=0.4",
          "rect:at=-4,1,0;aim=0,1,0;size=0.2x2"}) {
        const auto light = lightOf(text, kBox, "16x16");
        const auto view = fitLightView(light, kBox, kBox.centre(), 512, 1);
        double lowest = 1e9, nearest = 1e9;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p(corner & 1 ? kBox.high.x : kBox.low.x,
                               corner & 2 ? kBox.high.y : kBox.low.y,
                               corner & 4 ? kBox.high.z : kBox.low.z);
            nearest = std::min(nearest, glm::dot(p - light.centre, light.axisZ));
            for (const auto& s : light.samples) {
                const auto pixel = byMatrix(light, view, s, p);
                EXPECT_LE(pixel.z, 1);
                for (const double c : {pixel.x, pixel.y, 512 - pixel.x, 512 - pixel.y})
                    lowest = std::min(lowest, c);
            }
        }
        EXPECT_GE(lowest, 0) << text;
        EXPECT_LT(lowest, 0.05 * 512)
            << text;  // 2 % to spare, and cells do not reach the light's border
        const double expected = std::max(0.9 * nearest, 0.25 * std::max(light.width, light.height));
        EXPECT_NEAR(view.params.near, expected, 1e-5) << text;
    }
}

TEST(LightView, FieldOfViewIsTheSmallestPlusTwoPercent) {
    // A cube below the light: the nearest corners from the far edge of the light decide
    const auto bounds = boundsOf({-1, -1, -1}, {1, 1, 1});
    const auto light = lightOf("rect:at=0,5,0;aim=0,0,0;up=0,0,1;size=1x0.5", bounds);
    const auto view = fitLightView(light, bounds, bounds.centre(), 256, 1);
    EXPECT_NEAR(view.params.tanHalfFov, 1.02 * (1 + 0.5) / 4, 1e-6);
}

TEST(LightView, EnlargedViewFollowsEquationsOneToThree) {
    auto light = lightOf("rect:at=0,5,0;aim=0,0,0;up=0,0,1;size=2x1;fov=60;near=1.5", kBox);
    const auto view = fitLightView(light, kBox, kBox.centre(), 1000, 1);
    const double t = std::tan(M_PI / 6), distance = 2 / (2 * t);
    EXPECT_NEAR(view.params.tanHalfFov, t, 1e-6);
    EXPECT_NEAR(view.params.setBack, distance, 1e-5);
    EXPECT_EQ(view.params.enlarged, static_cast<int>(std::ceil(1000 * (1.5 + distance) / 1.5)));
    EXPECT_EQ(view.enlarged.width, view.params.enlarged);
    EXPECT_EQ(view.density, 1);
    const auto dense = fitLightView(light, kBox, kBox.centre(), 1000, 1.5);
    EXPECT_EQ(dense.params.enlarged, static_cast<int>(std::ceil(1500 * (1.5 + distance) / 1.5)));
}

TEST(LightView, EnlargedViewHoldsWhateverAnySampleViewHolds) {
    const auto light = lightOf("rect:at=1,5,2;aim=0,0,0;size=2x1", kBox, "8x8");
    const auto view = fitLightView(light, kBox, kBox.centre(), 512, 1);
    const auto& r = view.enlarged;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0, 1), deep(view.params.near, 20);
    for (int i = 0; i < 20000; ++i) {
        const auto& s = light.samples[static_cast<std::size_t>(i) % light.samples.size()];
        const double z = deep(random), t = view.params.tanHalfFov;
        const glm::dvec3 world =
            light.centre + (s.x + (2 * unit(random) - 1) * t * z) * light.axisX +
            (s.y + (2 * unit(random) - 1) * t * z) * light.axisY + z * light.axisZ;
        const glm::dvec3 p = world - kBox.centre();
        const auto dot = [&](const shared::float4& row) {
            return row.x * p.x + row.y * p.y + row.z * p.z + row.w;
        };
        const double w = dot(r.rowW);
        EXPECT_GE(dot(r.rowX) / w, -0.01);
        EXPECT_LE(dot(r.rowX) / w, r.width + 0.01);
        EXPECT_GE(dot(r.rowY) / w, -0.01);
        EXPECT_LE(dot(r.rowY) / w, r.height + 0.01);
        EXPECT_LE(dot(r.rowD), w);  // not cut by the near plane
    }
}

TEST(LightView, EnlargedViewIsCappedAndTellsTheDensityLeft) {
    const auto light = lightOf("rect:at=0,5,0;aim=0,0,0;up=0,0,1;size=4x4;near=1;fov=60", kBox);
    const auto view = fitLightView(light, kBox, kBox.centre(), 4096, 1);
    const double wanted = std::ceil(4096 * (1 + 2 / std::tan(M_PI / 6)));
    EXPECT_EQ(view.params.enlarged, 8192);
    EXPECT_NEAR(view.density, 8192 / wanted, 1e-9);
    EXPECT_EQ(fitLightView(light, kBox, kBox.centre(), 512, 1).density, 1);
}

TEST(LightView, FieldOfViewStopsAt140DegreesAndNearAtAQuarterOfTheLight) {
    const auto light =
        lightOf("rect:at=0,1,0;aim=0,0,0;up=0,0,1;size=2x1", kBox);  // among the casters
    const auto view = fitLightView(light, kBox, kBox.centre(), 512, 1);
    EXPECT_NEAR(view.params.tanHalfFov, std::tan(70 * M_PI / 180), 1e-5);
    EXPECT_NEAR(view.params.near, 0.5, 1e-6);
}

TEST(LightView, APointLightHasOneViewThatIsTheEnlargedOne) {
    auto light = lightOf("rect:at=0,5,0;aim=0,0,0;up=0,0,1;size=1x1", kBox);
    light.width = light.height = 0;
    light.samples = {{0, 0}};
    const auto view = fitLightView(light, kBox, kBox.centre(), 512, 1);
    EXPECT_EQ(view.params.enlarged, 512);
    EXPECT_EQ(view.params.setBack, 0);
    EXPECT_EQ(view.params.views, 1);
}

TEST(LightView, OpacityShuffleIsAPermutationOfTheViews) {
    for (const char* samples : {"1", "2", "12", "63", "64", "300"}) {
        const auto light = lightOf("rect:at=0,5,0;aim=0,0,0;size=1x1", kBox, samples);
        const auto p = fitLightView(light, kBox, kBox.centre(), 512, 1).params;
        std::vector<bool> seen(static_cast<std::size_t>(p.views), false);
        for (int i = 0; i < p.views; ++i)
            seen[static_cast<std::size_t>(i * p.sampleStride % p.views)] = true;
        EXPECT_EQ(std::count(seen.begin(), seen.end(), true), p.views) << samples;
    }
}

}  // namespace
}  // namespace penumbra::tests
