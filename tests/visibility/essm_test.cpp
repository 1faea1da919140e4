// SPDX-License-Identifier: MIT
// Pyramid, lookup and the exponential against the twin; what the technique makes of slopes, leaks
// and edges.
#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "kernels/shared/single_view.h"
#include "runtime/kernel.h"
#include "tests/reference/essm_ref.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using U32 = std::uint32_t;

constexpr int kReceivers = 701;

/// A plane that the map sees, and rectangles of casters of any depth before it.
struct Case {
    Case(unsigned seed, int resolution) : random(seed), view{0.7, 0.9, 0, 0, resolution} {
        normal = glm::normalize(glm::dvec3{between(-1, 1), between(-1, 1), between(-1.5, -0.6)});
        distance = between(2, 3.5);
        settings.nearZ = view.near;
        settings.range = between(3, 6);
        settings.leak = 0.05;
        settings.constantTexels = 0.25;
        settings.halfSize = {between(0.1, 0.4), between(0.1, 0.4)};
        for (int i = 0; i < kReceivers; ++i) {
            const glm::dvec3 ray{view.tanHalfFov * between(-1, 1), view.tanHalfFov * between(-1, 1),
                                 1};
            const double z = distance * normal.z / glm::dot(normal, ray);
            receivers.push_back({z > 1 && z < 20 ? ray * z : ray * distance, normal});
            if (i % 7 == 0) receivers.back().normal = grazing(receivers.back().origin);
        }
        fillMaps();
    }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    /// A normal whose plane passes within the light or near to it.
    glm::dvec3 grazing(const glm::dvec3& origin) {
        const glm::dvec3 to = glm::dvec3{between(-0.3, 0.3), between(-0.3, 0.3), 0} - origin;
        return glm::normalize(glm::cross(to, glm::dvec3{between(-1, 1), between(-1, 1), 0.3}));
    }
    void fillMaps() {
        const double middle = 0.5 * view.resolution;
        for (int row = 0; row < view.resolution; ++row)
            for (int column = 0; column < view.resolution; ++column) {
                const glm::dvec3 ray((column + 0.5 - middle) / view.focal(),
                                     (row + 0.5 - middle) / view.focal(), 1);
                const double w = view.near * glm::dot(normal, ray) / (distance * normal.z);
                plane.push_back(
                    static_cast<float>(between(0, 1) < 0.05 ? 0 : std::clamp(w, 0.0, 1.0)));
            }
        casters.assign(plane.size(), 0);
        for (int i = 0; i < 6; ++i) {
            const int size = view.resolution / 4;
            const int left = static_cast<int>(between(0, 3 * size)),
                      top = static_cast<int>(between(0, 3 * size));
            const auto w = static_cast<double>(static_cast<float>(between(0.15, 0.9)));
            for (int row = top; row < top + size; ++row)
                for (int column = left; column < left + size; ++column)
                    casters[static_cast<std::size_t>(row * view.resolution + column)] = w;
        }
    }
    std::mt19937 random;
    ViewGeometry view;
    glm::dvec3 normal{0};
    double distance = 0;
    EssmReference settings;
    std::vector<PlaneReceiver> receivers;
    std::vector<double> casters, plane;
};

std::vector<U32> bitsOf(const std::vector<double>& depths) {
    std::vector<U32> bits;
    for (const double depth : depths) bits.push_back(std::bit_cast<U32>(static_cast<float>(depth)));
    return bits;
}

/// What the kernels are launched with.
struct Launch {
    explicit Launch(const Case& c) {
        light.resolution = c.view.resolution;
        light.near = static_cast<float>(c.view.near);
        light.focal = static_cast<float>(c.view.focal());
        bias.constantTexels = static_cast<float>(c.settings.constantTexels);
        bias.constantMetres = static_cast<float>(c.settings.constantMetres);
        auto& p = params;
        p.exponent = static_cast<float>(c.settings.exponent);
        p.nearZ = static_cast<float>(c.settings.nearZ);
        p.inverseRange = static_cast<float>(1 / c.settings.range);
        p.leak = static_cast<float>(c.settings.leak);
        p.leastRadius = static_cast<float>(c.settings.leastRadius);
        p.reachX = static_cast<float>(c.settings.halfSize.x * c.view.focal() / c.view.near);
        p.reachY = static_cast<float>(c.settings.halfSize.y * c.view.focal() / c.view.near);
        for (int size = c.view.resolution;; size = (size + 1) / 2) {
            p.firstTexel[p.levels] = p.texels;
            p.size[p.levels++] = size;
            p.texels += size * size;
            if (size == 1) break;
        }
    }
    Buffer<float> pyramid(const Case& c) const {
        Buffer<U32> casters(device(), "casters", bitsOf(c.casters)),
            plane(device(), "receivers", bitsOf(c.plane));
        Buffer<float> result(device(), "pyramid", static_cast<std::uint64_t>(2 * params.texels));
        result.fill(-1);
        runtime::Kernel<shared::MultiViewParams, shared::EssmParams, Buffer<U32>, Buffer<U32>,
                        Buffer<float>>
            base(program("essm"), "essm_base");
        runtime::Kernel<shared::EssmParams, int, Buffer<float>> reduce(program("essm"),
                                                                       "essm_reduce");
        base.launch({c.casters.size()}, {64}, light, params, casters, plane, result);
        for (int level = 1; level < params.levels; ++level) {
            const auto size = static_cast<std::uint64_t>(params.size[level]);
            reduce.launch({size * size}, {64}, params, level, result);
        }
        return result;
    }
    shared::MultiViewParams light{};
    shared::LookupParams bias{};
    shared::EssmParams params{};
};

std::vector<float> receiverPlanes(const Case& c, std::size_t stride) {
    std::vector<float> planes(RECEIVER_PLANES * stride, 0.0F);
    for (std::size_t i = 0; i < c.receivers.size(); ++i) {
        if (i % 9 == 4) continue;  // not to be tested
        const auto& r = c.receivers[i];
        const double middle = 0.5 * c.view.resolution;
        const double values[] = {c.view.focal() * r.origin.x / r.origin.z + middle,
                                 c.view.focal() * r.origin.y / r.origin.z + middle,
                                 c.view.near / r.origin.z,
                                 c.view.near * r.normal.x / c.view.focal(),
                                 c.view.near * r.normal.y / c.view.focal(),
                                 -glm::dot(r.normal, r.origin)};
        for (std::size_t k = 0; k < RECEIVER_PLANES; ++k)
            planes[k * stride + i] = static_cast<float>(values[k]);
    }
    return planes;
}

class EssmTwinTest : public testing::TestWithParam<int> {};

TEST_P(EssmTwinTest, EveryLevelOfThePyramidHoldsTheMeansOfTheTwin) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        const Case c(seed, GetParam());
        const Launch launch(c);
        const auto pyramid = launch.pyramid(c).download();
        const auto twin =
            essmPyramid(c.casters, c.plane, c.view.resolution, c.view.near, c.settings);
        ASSERT_EQ(static_cast<std::size_t>(launch.params.levels), twin.size());
        std::size_t at = 0;
        for (std::size_t level = 0; level < twin.size(); ++level)
            for (std::size_t i = 0; i < twin[level].depths.size(); ++i, ++at) {
                // e^(c d) repeats the error of d c times
                ASSERT_NEAR(pyramid[at] / twin[level].exponentials[i], 1, 3e-5)
                    << "level " << level << " texel " << i;
                ASSERT_NEAR(pyramid[static_cast<std::size_t>(launch.params.texels) + at],
                            twin[level].depths[i], 1e-6)
                    << "level " << level << " texel " << i;
            }
    }
}

TEST_P(EssmTwinTest, VisibilityEqualsTheTwinWithinWhatFloatCarries) {
    std::size_t compared = 0, wrong = 0, dark = 0, between = 0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const Case c(seed, GetParam());
        const Launch launch(c);
        const auto stride = static_cast<std::size_t>(shared::gbufferStride(kReceivers));
        Buffer<float> receivers(device(), "receivers", receiverPlanes(c, stride));
        const auto pyramid = launch.pyramid(c);
        Buffer<U32> hidden(device(), "hidden", stride);
        hidden.fill(1000);
        runtime::Kernel<shared::MultiViewParams, shared::LookupParams, shared::EssmParams, int,
                        Buffer<float>, Buffer<float>, Buffer<U32>>
            kernel(program("essm"), "essm");
        kernel.launch({stride / static_cast<std::size_t>(device().info().lanes)}, {64},
                      launch.light, launch.bias, launch.params, static_cast<int>(stride), receivers,
                      pyramid, hidden);
        const auto result = hidden.download();
        const auto twin =
            essmPyramid(c.casters, c.plane, c.view.resolution, c.view.near, c.settings);
        for (std::size_t i = 0; i < stride; ++i) {
            if (i >= kReceivers || i % 9 == 4) {
                ASSERT_EQ(result[i], 1000U) << i;
                continue;
            }
            const auto expected = essmReference(c.receivers[i], c.view, twin, c.settings);
            if (!expected.certain) continue;
            ++compared;
            const double visibility = 1 - (result[i] - 1000) / 65535.0;
            wrong += std::abs(visibility - expected.visibility) > 2e-3;
            dark += expected.visibility < 0.05;
            between += expected.visibility >= 0.05 && expected.visibility <= 0.95;
        }
    }
    // A blocker's depth of few texels decides which ones the filter reads
    EXPECT_GT(compared, 4 * kReceivers * 6 / 10U);
    EXPECT_LE(wrong, compared / 100);
    EXPECT_GT(dark, compared / 20);
    EXPECT_GT(between, compared / 20);
}

INSTANTIATE_TEST_SUITE_P(Sizes, EssmTwinTest, testing::Values(33, 64, 101));

TEST(EssmExponentialTest, ErrorStaysWithinAnUlpOverTheWholeRange) {
    constexpr int kSize = 512;
    shared::MultiViewParams light{};
    light.resolution = kSize;
    light.near = 1;
    std::vector<double> depths;
    for (int i = 0; i < kSize * kSize; ++i) depths.push_back(kSize * kSize / (i + 0.25));
    Buffer<U32> casters(device(), "casters", bitsOf(depths));
    Buffer<float> pyramid(device(), "pyramid", 2 * kSize * kSize);
    runtime::Kernel<shared::MultiViewParams, shared::EssmParams, Buffer<U32>, Buffer<U32>,
                    Buffer<float>>
        base(program("essm"), "essm_base");
    for (const float exponent : {87.0F, -87.0F, 1.0F, -1.0F}) {
        shared::EssmParams params{};
        params.exponent = exponent;
        params.inverseRange = 1;
        params.texels = kSize * kSize;
        base.launch({kSize * kSize}, {64}, light, params, casters, casters, pyramid);
        const auto values = pyramid.download();
        double worst = 0, least = 1e300, most = -1e300;
        for (std::size_t i = 0; i < kSize * kSize; ++i) {
            const float x = exponent * values[kSize * kSize + i];
            worst = std::max(worst, std::abs(values[i] / std::exp(static_cast<double>(x)) - 1));
            least = std::min(least, static_cast<double>(x));
            most = std::max(most, static_cast<double>(x));
        }
        std::printf("[ ERROR    ] e^x over [%.1f, %.1f]: %.2e\n", least, most, worst);
        EXPECT_LT(worst, 1.2e-7);
        EXPECT_GT(most - least, 0.99 * std::abs(exponent));
    }
}

ShadowSetup essmSetup() {
    ShadowSetup setup;
    setup.technique = "essm";
    setup.light = "rect:at=0,4,0;aim=0,0,0;up=0,0,1;size=1x1;radiance=10;fov=70;near=1.5";
    setup.eye = {0.3, 0.9, 2.4};
    setup.width = 120;
    setup.height = 90;
    return setup;
}

TEST(EssmTest, SlopingReceiversWithoutBlockersAreLitEverywhere) {
    for (const double degrees : {0.0, 20.0, 40.0, 60.0, 70.0}) {
        const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
        SceneBuilder builder;
        builder.material().doubleSided = true;
        const glm::vec3 along(0, s, -c);
        builder.addQuad(-along - glm::vec3(1, 0, 0), {2, 0, 0}, 2.0F * along);
        const auto run = runShadows(builder.scene(), essmSetup());
        double least = 1;
        std::size_t tested = 0;
        for (std::size_t i = 0; i < run.pixels(); ++i) {
            if (!run.tested(i)) continue;
            least = std::min(least, static_cast<double>(run.visibility[i]));
            ++tested;
        }
        std::printf("[ SLOPE    ] %.0f degrees: visibility at least %.4f\n", degrees, least);
        EXPECT_GT(tested, 1000U);
        EXPECT_GT(least, degrees > 60 ? 0.97 : 0.995) << degrees;
    }
}

scene::Scene edgeScene() {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addQuad({-3, 1.5F, 2}, {3, 0, 0}, {0, 0, -4});
    return builder.scene();
}

TEST(EssmTest, LeakMovesVisibilityDownByItsShare) {
    auto setup = essmSetup();
    setup.settings["essm.leak"] = "0";
    const auto plain = runShadows(edgeScene(), setup);
    setup.settings["essm.leak"] = "0.3";
    const auto dark = runShadows(edgeScene(), setup);
    std::size_t moved = 0;
    for (std::size_t i = 0; i < plain.pixels(); ++i) {
        if (!plain.tested(i)) continue;
        const double expected = std::max(plain.visibility[i] - 0.3, 0.0) / 0.7;
        EXPECT_NEAR(dark.visibility[i], expected, 3e-5) << i;
        moved += dark.visibility[i] != plain.visibility[i];
    }
    EXPECT_GT(moved, 500U);
}

TEST(EssmTest, ALargerExponentLeaksLessBehindAnEdge) {
    auto setup = essmSetup();
    setup.settings["essm.leak"] = "0";
    double leaks[2] = {0, 0};
    for (const int k : {0, 1}) {
        setup.settings["essm.exponent"] = k ? "80" : "4";
        const auto run = runShadows(edgeScene(), setup);
        std::size_t count = 0;
        for (std::size_t i = 0; i < run.pixels(); ++i) {
            const auto p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
            if (!run.tested(i) || std::abs(p.y) > 1e-3 || p.x > -0.4) continue;  // the umbra
            leaks[k] += run.visibility[i];
            ++count;
        }
        ASSERT_GT(count, 500U);
        leaks[k] /= static_cast<double>(count);
    }
    EXPECT_GT(leaks[0], 0.05);
    EXPECT_LT(leaks[1], 0.001);
}

TEST(EssmTest, ThePenumbraOfAnEdgeIsNearlyAsWideAsParallelPlanesHaveIt) {
    auto setup = essmSetup();
    setup.settings["essm.leak"] = "0";
    const auto run = runShadows(edgeScene(), setup);
    std::size_t partly = 0, expected = 0;
    double offset = 0;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const auto p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
        if (!run.tested(i) || std::abs(p.y) > 1e-3) continue;
        // A square light: visibility grows linearly over size (zr - zb) / zb = 0.6 m
        const double truth = std::clamp(0.5 + p.x / 0.6, 0.0, 1.0);
        partly += run.visibility[i] > 0.1F && run.visibility[i] < 0.9F;
        expected += truth > 0.1 && truth < 0.9;
        offset += truth - run.visibility[i];
    }
    std::printf("[ PENUMBRA ] %zu pixels between 0.1 and 0.9, on paper %zu\n", partly, expected);
    ASSERT_GT(expected, 500U);
    EXPECT_NEAR(static_cast<double>(partly) / static_cast<double>(expected), 1, 0.15);
    EXPECT_LT(std::abs(offset) / static_cast<double>(expected), 0.05);
}

}  // namespace
}  // namespace penumbra::tests
