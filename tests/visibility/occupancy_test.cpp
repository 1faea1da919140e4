// SPDX-License-Identifier: MIT
// Receivers that no caster can shadow: leaving them out changes no byte, and leaves out what it
// can.
#include "host/visibility/occupancy.h"

#include <cstring>
#include <random>

#include "kernels/shared/multi_view.h"
#include "tests/reference/occupancy_ref.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

scene::Scene solids() {
    SceneBuilder builder;
    builder.addQuad({-6, 0, 6}, {12, 0, 0}, {0, 0, -12}, false);
    builder.addSphere({-0.7F, 0.8F, 0.2F}, 0.5F, 16, 24);
    builder.addBox({0.4F, 0.3F, -0.6F}, {1.0F, 0.9F, 0.1F});
    builder.addMesh({{1.2F, 0, 0.2F}, {1.25F, 0, 0.2F}, {1.2F, 2.5F, 0.6F}}, {0, 1, 2});
    return builder.scene();
}

struct Setting {
    const char* light;
    const char* technique;
    SettingValues settings;
};

class OccupancyImageTest : public testing::TestWithParam<Setting> {};

TEST_P(OccupancyImageTest, LeavingOutWhatIsLitChangesNoByte) {
    const auto& [light, technique, settings] = GetParam();
    ShadowSetup setup;
    setup.light = light;
    setup.technique = technique;
    setup.settings = settings;
    setup.samples = "9";
    setup.eye = {1, 3, 6};
    setup.fovDegrees = 70;
    setup.width = 131;
    setup.height = 97;
    const std::string key = std::string(technique) + ".skipLit";
    setup.settings[key] = "false";
    const auto all = runShadows(solids(), setup);
    setup.settings[key] = "true";
    const auto some = runShadows(solids(), setup);
    EXPECT_EQ(std::memcmp(all.visibility.data(), some.visibility.data(),
                          all.visibility.size() * sizeof(float)),
              0);
    EXPECT_EQ(all.state, some.state);
}

const char* const kUsual = "rect:at=2,5,1;aim=0,0.5,0;size=1x0.6";
INSTANTIATE_TEST_SUITE_P(
    Lights, OccupancyImageTest,
    testing::Values(Setting{kUsual, "vwss", {{"vwss.resolution", "128"}}},
                    Setting{kUsual, "mvr", {{"mvr.pcf", "9"}, {"mvr.depthBits", "16"}}},
                    Setting{
                        kUsual, "mvr", {{"mvr.pcf", "bilinear"}, {"mvr.coverage", "conservative"}}},
                    Setting{kUsual, "mvss", {}},
                    Setting{kUsual, "vwss", {{"vwss.halfResolution", "true"}}},
                    Setting{kUsual, "vwss", {{"vwss.precision", "fixed"}, {"vwss.density", "0.5"}}},
                    // Wide and near, grazing, inside of the casters' bounds, a point, from below
                    Setting{"rect:at=0,2.6,0;aim=0,0,0;up=0,0,1;size=3x3", "vwss", {}},
                    Setting{"disk:at=8,0.7,0;aim=0,0.5,0;radius=0.8", "mvr", {}},
                    Setting{"rect:at=0,1.5,0;aim=1,0,0;size=0.5x0.5", "mvr", {}},
                    Setting{"rect:at=1,4,2;aim=0,0,0;size=0x0", "vwss", {}},
                    Setting{"rect:at=1,4,2;aim=0,0,0;size=1x1;near=3.2", "mvr", {}}));

/// Receivers all over the central view of a light, as receivers() leaves them.
std::vector<float> receiversOver(const visibility::LightView& view, int stride, unsigned seed) {
    std::mt19937 random(seed);
    const auto size = static_cast<float>(view.params.resolution);
    std::uniform_real_distribution<float> place(-0.4F * size, 1.4F * size), depth(0.2F, 1);
    std::vector<float> planes(static_cast<std::size_t>(RECEIVER_PLANES * stride));
    for (std::size_t i = 0; i < static_cast<std::size_t>(stride); ++i) {
        const auto at = [&](int plane) -> float& {
            return planes[static_cast<std::size_t>(plane * stride) + i];
        };
        at(RECEIVER_A) = place(random);
        at(RECEIVER_B) = place(random);
        at(RECEIVER_W) = i % 7 == 0 ? 0 : depth(random);
        at(RECEIVER_GRADIENT_X) = i % 5 == 0 ? 1.0F : 1e-4F;
        at(RECEIVER_FACING) = i % 11 == 0 ? -1.0F : 2.0F;
    }
    return planes;
}

TEST(OccupancyTest, LeavesOutExactlyWhatTheTwinLeavesOut) {
    const auto scene = solids();
    const auto pose = scene::poseAt(scene, {}, 0);
    const auto bounds = scene::clipBounds(scene, {});
    geometry::Geometry geometry(program("frame"), scene, bounds.centre());
    const auto& mesh = geometry.run(pose);
    auto light = scene::parseLight("rect:at=2,5,1;aim=0,0.5,0;size=1x0.6");
    auto lit = scene;
    lit.lights = {light};
    const auto area = scene::lightsAt(lit, pose, bounds, scene::parseSampleCount("9", {})).at(0);
    const auto view = visibility::fitLightView(area, bounds, bounds.centre(), 256, 1);
    constexpr int kStride = 4096;
    const auto before = receiversOver(view, kStride, 3);
    runtime::Buffer<float> receivers(device(), "receivers", before);
    visibility::Occupancy occupancy(program("multi_view"));
    occupancy.skip(mesh, view, kStride, receivers);
    const auto after = receivers.download();
    const auto twin = shadowableReceivers(mesh, view, before, kStride);
    std::size_t left = 0, kept = 0, wrong = 0;
    for (std::size_t i = 0; i < kStride; ++i) {
        const std::size_t w = RECEIVER_W * kStride + i;
        if (before[w] == 0) {
            ASSERT_EQ(after[w], 0);
            continue;
        }
        (after[w] == 0 ? left : kept) += 1;
        ASSERT_TRUE(after[w] == 0 || after[w] == before[w]);
        // Nothing that may be shadowed is left out; what is kept in vain lies within cells of
        // casters
        ASSERT_FALSE(after[w] == 0 && twin[i] == Shadowable::yes) << i;
        wrong += after[w] != 0 && twin[i] == Shadowable::no ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_GT(left, 1000U);
    EXPECT_GT(kept, 500U);
    for (int plane = 0; plane < RECEIVER_PLANES; ++plane) {
        if (plane == RECEIVER_W) continue;
        const auto first = static_cast<std::ptrdiff_t>(plane) * kStride;
        EXPECT_TRUE(std::equal(before.begin() + first, before.begin() + first + kStride,
                               after.begin() + first));
    }
}

}  // namespace
}  // namespace penumbra::tests
