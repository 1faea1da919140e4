// SPDX-License-Identifier: MIT
// Random light samples of each pixel's own: where they lie, and how their mean comes to the truth.
#include <cmath>

#include "host/pipeline.h"
#include "kernels/shared/gbuffer.h"
#include "runtime/error.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

constexpr double kLight = 4, kSheet = 3.9;  // heights

/// Rays to random samples of a light of half size 0.5 at height 4.
ShadowSetup randomSetup(const char* shape, const std::string& samples) {
    ShadowSetup setup;
    setup.technique = "raytrace";
    setup.light = std::string(shape) + ";at=0,4,0;aim=0,0,0;up=0,0,1;radiance=10";
    setup.samples = samples;
    setup.pattern = scene::Pattern::random;
    setup.eye = {0.2, 1.2, 2.6};
    setup.width = 96;
    setup.height = 64;
    return setup;
}

/// A floor of 2 x 2 m under a thin sheet just below the light that reaches from x = edge to the
/// left.
scene::Scene half(float edge) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addQuad({edge - 3, static_cast<float>(kSheet), 2}, {3, 0, 0}, {0, 0, -4});
    return builder.scene();
}

/// Share of the light of half size 0.5 that a floor point at x sees past the sheet's edge.
double seen(double x, float edge, bool disk) {
    // The edge, seen from the floor, cuts the light at this x, in half sizes
    const double cut = (x + (static_cast<double>(edge) - x) * kLight / kSheet) / 0.5;
    const double t = std::clamp(cut, -1.0, 1.0);
    return disk ? (std::acos(t) - t * std::sqrt(1 - t * t)) / M_PI : (1 - t) / 2;
}

struct Statistics {
    double mean = 0, deviation = 0, rays = 0;  ///< of visibility - truth; expected deviation
    std::size_t pixels = 0;
};

Statistics statistics(const ShadowRun& run, float edge, bool disk, double samples) {
    Statistics s;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const auto p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
        if (!run.tested(i) || std::abs(p.y) > 1e-3) continue;
        const double truth = seen(p.x, edge, disk), error = run.visibility[i] - truth;
        s.mean += error;
        s.deviation += error * error;
        s.rays += truth * (1 - truth) / samples;
        ++s.pixels;
    }
    const auto count = static_cast<double>(s.pixels);
    s.mean /= count;
    s.deviation = std::sqrt(s.deviation / count);
    s.rays = std::sqrt(s.rays / count);
    return s;
}

class RaytraceRandomTest : public testing::TestWithParam<bool> {
  protected:
    bool disk() const { return GetParam(); }
    const char* shape() const { return disk() ? "disk:radius=0.5" : "rect:size=1x1"; }
};

TEST_P(RaytraceRandomTest, ErrorsAreThoseOfIndependentRaysAndFallWithTheRootOfTheirNumber) {
    for (const float edge : {0.0F, 0.25F, -0.3F}) {
        for (const int samples : {1, 4, 16, 37, 256}) {
            const auto run = runShadows(half(edge), randomSetup(shape(), std::to_string(samples)));
            const auto s = statistics(run, edge, disk(), samples);
            ASSERT_GT(s.pixels, 1500U);
            // Binomial: the deviation of a pixel is sqrt(p (1 - p) / N), that of their mean less by
            // the root of their number
            EXPECT_NEAR(s.deviation / s.rays, 1, 0.06) << samples << " samples, edge " << edge;
            EXPECT_LT(std::abs(s.mean), 4 * s.rays / std::sqrt(static_cast<double>(s.pixels)))
                << samples << " samples, edge " << edge;
        }
    }
}

TEST_P(RaytraceRandomTest, AnUnoccludedLightIsSeenWhole) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    const auto run = runShadows(builder.scene(), randomSetup(shape(), "19"));
    for (std::size_t i = 0; i < run.pixels(); ++i)
        if (run.tested(i)) {
            ASSERT_EQ(run.visibility[i], 1);
        }
}

TEST_P(RaytraceRandomTest, SamplesStayInTheLight) {
    // A frame of sheets hides all but a hole a little larger than the light
    SceneBuilder builder;
    builder.addQuad({-0.02F, 0, 0.02F}, {0.04F, 0, 0}, {0, 0, -0.04F}, false);
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
    constexpr int kCorners = 64;
    for (int i = 0; i < kCorners; ++i) {
        const double angle = 2 * M_PI * i / kCorners;  // through the corners of the square
        const double c = std::cos(angle), s = std::sin(angle);
        const double inner =
            disk() ? 0.505 / std::cos(M_PI / kCorners) : 0.505 / std::max(std::abs(c), std::abs(s));
        for (const double r : {inner, 3.0})
            positions.emplace_back(r * c, static_cast<float>(kLight - 0.001), r * s);
        const auto at = static_cast<std::uint32_t>(2 * i), next = (at + 2) % (2 * kCorners);
        for (const auto index : {at, at + 1, next, next, at + 1, next + 1})
            indices.push_back(index);
    }
    builder.addMesh(positions, indices);
    auto setup = randomSetup(shape(), "256");
    setup.eye = {0, 0.05, 0.08};
    const auto run = runShadows(builder.scene(), setup);
    std::size_t tested = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        if (!run.tested(i)) continue;
        ++tested;
        ASSERT_EQ(run.visibility[i], 1) << i;
    }
    EXPECT_GT(tested, 500U);
}

TEST_P(RaytraceRandomTest, SeedsAndPixelsHaveSamplesOfTheirOwn) {
    auto setup = randomSetup(shape(), "8");
    const auto first = runShadows(half(0), setup), again = runShadows(half(0), setup);
    EXPECT_EQ(first.visibility, again.visibility);
    setup.seed = 1;
    const auto other = runShadows(half(0), setup);
    double product = 0, neighbours = 0, square = 0;
    for (std::size_t i = 0; i + 1 < first.pixels(); ++i) {
        if (!first.tested(i) || !first.tested(i + 1)) continue;
        const auto error = [&](const ShadowRun& run, std::size_t k) {
            const auto p = glm::dvec3(run.vectorAt(GB_POSITION, k)) + run.bounds.centre();
            return run.visibility[k] - seen(p.x, 0, disk());
        };
        product += error(first, i) * error(other, i);
        neighbours += error(first, i) * error(first, i + 1);
        square += error(first, i) * error(first, i);
    }
    EXPECT_LT(std::abs(product), 0.08 * square);
    EXPECT_LT(std::abs(neighbours), 0.08 * square);
}

INSTANTIATE_TEST_SUITE_P(Shapes, RaytraceRandomTest, testing::Bool());

TEST(RaytraceRandomUseTest, EveryOtherTechniqueRefusesRandomSamplesAsWrongUse) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
    for (const auto& entry : visibility::techniques()) {
        RenderOptions options;
        options.width = options.height = 16;
        options.technique = entry.name;
        options.lightPattern = "random";
        if (options.technique == "raytrace") {
            EXPECT_NO_THROW(Pipeline(options, builder.scene()));
            continue;
        }
        try {
            Pipeline(options, builder.scene());
            ADD_FAILURE() << entry.name << " takes random samples";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::usage);
            EXPECT_NE(std::string(error.what()).find("random"), std::string::npos);
        }
    }
}

}  // namespace
}  // namespace penumbra::tests
