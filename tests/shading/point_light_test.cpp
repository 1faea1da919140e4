// SPDX-License-Identifier: MIT
// A light that shrinks to a point keeps its picture: intensity = radiance x area.
#include <cmath>

#include "host/pipeline.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

std::vector<float> shadeWith(const std::string& light) {
    SceneBuilder builder;
    builder.addQuad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, false);
    builder.addSphere({0, 0.7F, 0}, 0.6F);
    builder.material().roughness = 0.3F;
    RenderOptions options;
    options.width = 64;
    options.height = 48;
    options.technique = "none";
    options.eye = {{0, 2, 3}};
    options.target = {{0, 0.3, 0}};
    options.device = std::getenv("PENUMBRA_DEVICE") ? "" : "cpu";
    auto scene = builder.scene();
    scene.lights.push_back(scene::parseLight(light));
    return Pipeline(options, scene).render(0).rgba;
}

TEST(PointLightTest, EqualsASmallDiskOfTheSameIntensity) {
    const double radius = 0.01, area = 3.14159265358979 * radius * radius;
    const auto disk = shadeWith("disk:at=1,3,1;aim=0,0.5,0;radius=0.01;radiance=10000");
    const auto point =
        shadeWith(fmt::format("sphere:at=1,3,1;aim=0,0.5,0;radius=0;radiance={}", 10000 * area));
    double brightest = 0;
    for (const float value : disk) brightest = std::max(brightest, static_cast<double>(value));
    ASSERT_GT(brightest, 0.1);
    // The disk shines one-sidedly with a cosine, the point evenly: alike only near the axis
    for (std::size_t i = 0; i < disk.size(); ++i)
        EXPECT_NEAR(disk[i], point[i], 0.3 * brightest) << i;
    const auto centre = 4 * (64 * 24 + 32);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(disk[centre + c], point[centre + c], 0.02 * point[centre + c]);
}

}  // namespace
}  // namespace penumbra::tests
