// SPDX-License-Identifier: MIT
// Lighting at half resolution against lighting at every pixel: close on whole scenes, and nothing
// crosses silhouettes.
#include <bit>
#include <cmath>
#include <cstdio>

#include "host/scene/builtin.h"
#include "kernels/shared/gbuffer.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

std::pair<ShadowRun, ShadowRun> fullAndHalf(const scene::Scene& scene, ShadowSetup setup) {
    auto full = runShadows(scene, setup);
    setup.settings["vwss.halfResolution"] = "true";
    return {std::move(full), runShadows(scene, setup)};
}

std::uint32_t objectAt(const ShadowRun& run, std::size_t pixel) {
    return std::bit_cast<std::uint32_t>(run.planes[GB_OBJECT * run.stride + pixel]);
}

TEST(HalfResolutionTest, TheBuiltinSceneIsCloseToFullResolution) {
    ShadowSetup setup;
    setup.placedCamera = false;
    setup.samples = "16";
    setup.width = 1281;
    setup.height = 719;
    const auto [full, half] = fullAndHalf(scene::loadBuiltinScene(), setup);
    ASSERT_EQ(full.state, half.state);
    // Tested pixels of even column and row are kept up to their neighbours' tents, which are 0
    // there
    std::size_t even = 0, moved = 0, interpolated = 0;
    double sum = 0;
    for (std::size_t i = 0; i < full.pixels(); ++i) {
        if (!full.tested(i)) {
            EXPECT_EQ(half.visibility[i], 1);
            continue;
        }
        const auto x = i % 1281, y = i / 1281;
        const double difference = std::abs(full.visibility[i] - half.visibility[i]);
        if (x % 2 == 0 && y % 2 == 0) {
            ++even;
            moved += difference > 1e-6;
        } else {
            ++interpolated;
            sum += full.visibility[i] - half.visibility[i];
        }
    }
    const double error = rmse(half, full.visibility);
    std::printf("[ RMSE     ] built-in, half resolution against full: %.4f\n", error);
    EXPECT_GT(even, 20000U);
    EXPECT_EQ(moved, 0U);
    EXPECT_LT(error, 0.042);
    EXPECT_GT(error, 0.001);  // it does interpolate
    EXPECT_LT(std::abs(sum) / static_cast<double>(interpolated),
              0.002);  // neither darkens nor lights
}

TEST(HalfResolutionTest, LightDoesNotLeakAcrossSilhouettes) {
    // A lit table over a floor that it hides from the light altogether: the table's near edge
    // stands before the floor
    SceneBuilder builder;
    builder.addQuad({-0.9F, 0, 0.9F}, {1.8F, 0, 0}, {0, 0, -1.8F}, false);
    builder.addQuad({-3, 1.0F, 1.2F}, {6, 0, 0}, {0, 0, -2.4F});
    builder.material().doubleSided = true;
    ShadowSetup setup;
    setup.light = "rect:at=0,6,0;aim=0,0,0;up=0,0,1;size=0.5x0.5;radiance=10";
    setup.eye = {0.4, 3, 3};
    setup.target = {0, 0.5, 0.6};
    setup.width = 131;
    setup.height = 97;
    const auto [full, half] = fullAndHalf(builder.scene(), setup);
    std::size_t beside = 0, dark = 0, lit = 0;
    for (int y = 2; y + 2 < full.height; ++y)
        for (int x = 2; x + 2 < full.width; ++x) {
            const auto i = static_cast<std::size_t>(y * full.width + x);
            if (!full.tested(i)) continue;
            // Where the whole neighbourhood on this object is black or white, so is the pixel
            bool same = true, edge = false;
            for (int dy = -2; dy <= 2; ++dy)
                for (int dx = -2; dx <= 2; ++dx) {
                    const auto j = i + static_cast<std::size_t>(dy * full.width + dx);
                    const bool own = objectAt(full, j) == objectAt(full, i);
                    same &= !own || full.visibility[j] == full.visibility[i];
                    edge |= !own && full.tested(j);
                }
            if (!same) continue;
            (full.visibility[i] > 0.5F ? lit : dark) += 1;
            beside += edge;
            EXPECT_NEAR(half.visibility[i], full.visibility[i], 1e-6) << x << ',' << y;
        }
    EXPECT_GT(dark, 200U);
    EXPECT_GT(lit, 200U);
    EXPECT_GT(beside, 50U);
}

}  // namespace
}  // namespace penumbra::tests
