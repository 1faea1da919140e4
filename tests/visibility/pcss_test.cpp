// SPDX-License-Identifier: MIT
// Blocker search and filter against the twin on random maps, and what the technique makes of edges
// whose penumbra is known.
#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "kernels/shared/single_view.h"
#include "runtime/kernel.h"
#include "tests/reference/pcss_ref.h"
#include "tests/reference/shadow_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using U32 = std::uint32_t;

constexpr int kReceivers = 1003, kRowOfReceivers = 37;

/// Receivers on a plane, and a map whose texels lie a few of the plane's steps about its depth.
struct Case {
    Case(unsigned seed, int resolution, int searchTaps, int filterTaps)
        : random(seed), view{0.7, 0.9, 0, 0, resolution} {
        normal = glm::normalize(glm::dvec3{between(-1, 1), between(-1, 1), between(-1, -0.3)});
        distance = between(2, 4);
        for (int i = 0; i < kReceivers; ++i) {
            const glm::dvec3 ray{1.1 * view.tanHalfFov * between(-1, 1),
                                 1.1 * view.tanHalfFov * between(-1, 1), 1};
            const double z = distance * normal.z / glm::dot(normal, ray);
            receivers.push_back({z > 1 && z < 30 ? ray * z : ray * distance, normal});
            // Some turn away from the light's centre, but not from all of it
            if (i % 5 == 0) receivers.back().normal = grazing(receivers.back().origin);
        }
        fillMap();
        settings.bias.slopeBias = 1.1;
        settings.bias.constantTexels = 0.25;
        settings.halfSize = {between(0.2, 0.5), between(0.2, 0.5)};
        settings.leastSpread = 0.02;
        for (int i = 0; i < searchTaps; ++i) settings.search.push_back(inDisk());
        for (int i = 0; i < filterTaps; ++i) settings.filter.push_back(inDisk());
        for (int i = 0; i < PCSS_ROTATIONS; ++i) angles.push_back(between(0, 2 * M_PI));
    }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    glm::dvec2 inDisk() {
        const double r = std::sqrt(between(0, 1)), angle = between(0, 2 * M_PI);
        return {r * std::cos(angle), r * std::sin(angle)};
    }
    /// A normal whose plane passes within the light.
    glm::dvec3 grazing(const glm::dvec3& origin) {
        const glm::dvec3 to = glm::dvec3{between(-0.3, 0.3), between(-0.3, 0.3), 0} - origin;
        return glm::normalize(glm::cross(to, glm::dvec3{between(-1, 1), between(-1, 1), 0.3}));
    }
    void fillMap() {
        const double middle = 0.5 * view.resolution, at = distance * normal.z;
        const double step =
            view.near * (std::abs(normal.x) + std::abs(normal.y)) / (view.focal() * std::abs(at));
        for (int row = 0; row < view.resolution; ++row)
            for (int column = 0; column < view.resolution; ++column) {
                const glm::dvec3 ray((column + 0.5 - middle) / view.focal(),
                                     (row + 0.5 - middle) / view.focal(), 1);
                const double depth = view.near * glm::dot(normal, ray) / at;
                const double chance = between(0, 1);
                map.push_back(static_cast<float>(
                    chance < 0.3   ? 0
                    : chance < 0.5 ? between(0, 1)
                                   : std::clamp(depth + between(-2, 3) * step, 0.0, 1.0)));
            }
    }
    PcssReference settingsOf(std::size_t receiver) const {
        auto own = settings;
        const std::size_t row = receiver / kRowOfReceivers, column = receiver % kRowOfReceivers;
        own.angle = angles[(row % 16) * 16 + column % 16];
        return own;
    }
    std::mt19937 random;
    ViewGeometry view;
    glm::dvec3 normal{0};
    double distance = 0;
    PcssReference settings;
    std::vector<PlaneReceiver> receivers;
    std::vector<double> map, angles;
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

/// Runs the kernel; hidden taps start at 1000.
std::vector<U32> lookUp(const Case& c) {
    const auto stride = static_cast<std::size_t>(shared::gbufferStride(kReceivers));
    shared::MultiViewParams light{};
    light.resolution = c.view.resolution;
    light.near = static_cast<float>(c.view.near);
    light.focal = static_cast<float>(c.view.focal());
    shared::LookupParams bias{};
    bias.slopeBias = static_cast<float>(c.settings.bias.slopeBias);
    bias.constantTexels = static_cast<float>(c.settings.bias.constantTexels);
    bias.constantMetres = static_cast<float>(c.settings.bias.constantMetres);
    shared::PcssParams params{};
    params.blockerTaps = static_cast<int>(c.settings.search.size());
    params.filterTaps = static_cast<int>(c.settings.filter.size());
    params.reachX = static_cast<float>(c.settings.halfSize.x * c.view.focal() / c.view.near);
    params.reachY = static_cast<float>(c.settings.halfSize.y * c.view.focal() / c.view.near);
    params.leastSpread = static_cast<float>(c.settings.leastSpread);
    params.receiverWidth = kRowOfReceivers;
    params.planeBias = c.settings.planeBias ? 1 : 0;
    std::vector<float> patterns, rotations;
    for (const auto* taps : {&c.settings.search, &c.settings.filter})
        for (const auto& tap : *taps) {
            patterns.push_back(static_cast<float>(tap.x));
            patterns.push_back(static_cast<float>(tap.y));
        }
    for (const double angle : c.angles) {
        rotations.push_back(static_cast<float>(std::cos(angle)));
        rotations.push_back(static_cast<float>(std::sin(angle)));
    }
    std::vector<U32> texels;
    for (const double depth : c.map)
        texels.push_back(std::bit_cast<U32>(static_cast<float>(depth)));
    texels.push_back(std::bit_cast<U32>(1.0F));  // what fell outside: the nearest depth there is
    Buffer<float> receivers(device(), "receivers", receiverPlanes(c, stride)),
        points(device(), "patterns", patterns), turns(device(), "rotations", rotations);
    Buffer<U32> map(device(), "map", texels), hidden(device(), "hidden", stride);
    hidden.fill(1000);
    runtime::Kernel<shared::MultiViewParams, shared::LookupParams, shared::PcssParams, int,
                    Buffer<float>, Buffer<float>, Buffer<float>, Buffer<U32>, Buffer<U32>>
        kernel(program("pcss"), "pcss");
    kernel.launch({stride / static_cast<std::size_t>(device().info().lanes)}, {64}, light, bias,
                  params, static_cast<int>(stride), receivers, points, turns, map, hidden);
    return hidden.download();
}

void expectTwin(const Case& c) {
    const auto hidden = lookUp(c);
    std::size_t uncertain = 0, doubt = 0, none = 0, sum = 0;
    for (std::size_t i = 0; i < hidden.size(); ++i) {
        PcssOutcome twin;
        if (i < kReceivers && i % 9 != 4)
            twin = pcssReference(c.receivers[i], c.view, c.map, c.settingsOf(i));
        const int is = static_cast<int>(hidden[i]) - 1000;
        EXPECT_TRUE(is >= twin.hidden.low && is <= twin.hidden.high)
            << is << " is not within " << twin.hidden.low << " and " << twin.hidden.high
            << ", receiver " << i;
        uncertain += twin.certain ? 0 : 1;
        doubt += twin.certain ? static_cast<std::size_t>(twin.hidden.high - twin.hidden.low) : 0;
        none += twin.certain && i < kReceivers && i % 9 != 4 && twin.blocker == 0;
        sum += static_cast<std::size_t>(twin.hidden.low);
    }
    // What float may decide is rare, and neither answer fills the image
    const auto tests = kReceivers * c.settings.filter.size();
    EXPECT_LT(uncertain, kReceivers * (c.settings.search.size() + 20) / 400);
    EXPECT_LT(doubt, tests / 100);
    if (c.settings.search.size() == 1) {
        EXPECT_GT(none, kReceivers / 10U);
    }
    EXPECT_GT(sum, tests / 20);
    EXPECT_LT(sum, tests * 9 / 10);
}

class PcssTwinTest : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(PcssTwinTest, HiddenTapsEqualTheTwinOnRandomMaps) {
    const auto [search, filter] = GetParam();
    for (unsigned seed = 1; seed <= 3; ++seed)
        for (const int resolution : {33, 64, 101}) {
            SCOPED_TRACE(testing::Message() << "seed " << seed << ", maps of " << resolution);
            expectTwin(Case(seed, resolution, search, filter));
        }
}

INSTANTIATE_TEST_SUITE_P(Taps, PcssTwinTest,
                         testing::Values(std::pair(1, 1), std::pair(7, 13), std::pair(16, 5),
                                         std::pair(64, 96)));

TEST(PcssBiasTest, EveryKindOfBiasMovesTheTestsAsTheTwinSays) {
    for (const bool plane : {true, false})
        for (const auto& [slope, texels, metres] :
             {std::array{0.0, 0.0, 0.0}, {2.5, 0.0, 0.0}, {0.0, 1.5, 0.0}, {0.0, 0.0, 0.05}}) {
            Case c(7, 57, 16, 24);
            c.settings.planeBias = plane;
            c.settings.bias.slopeBias = slope;
            c.settings.bias.constantTexels = texels;
            c.settings.bias.constantMetres = metres;
            expectTwin(c);
        }
}

/// A disk light of 0.5 m radius at height 4 over a floor, a thin sheet over its half x < 0.
ShadowSetup edgeSetup(double radius = 0.5, const std::string& up = "0,0,1") {
    ShadowSetup setup;
    setup.technique = "pcss";
    setup.light = "disk:at=0,4,0;aim=0,0,0;up=" + up + ";radius=" + std::to_string(radius) +
                  ";fov=70;near=1.5";
    setup.eye = {0.3, 0.6, 1.6};
    setup.target = {0, 0, 0.2};
    setup.fovDegrees = 60;
    setup.width = 200;
    setup.height = 100;
    return setup;
}

scene::Scene edgeScene(float height) {
    SceneBuilder builder;
    builder.addQuad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, false);
    builder.addQuad({-3, height, 2}, {3, 0, 0}, {0, 0, -4});
    return builder.scene();
}

/// Pixels of the floor: (x, visibility), by x.
std::vector<std::pair<double, double>> profile(const ShadowRun& run) {
    std::vector<std::pair<double, double>> values;
    for (std::size_t i = 0; i < run.pixels(); ++i) {
        const auto p = glm::dvec3(run.vectorAt(GB_POSITION, i)) + run.bounds.centre();
        if (run.tested(i) && std::abs(p.y) < 1e-3) values.emplace_back(p.x, run.visibility[i]);
    }
    std::sort(values.begin(), values.end());
    return values;
}

/// x where the mean of 151 neighbours first passes `level`.
double crossing(const std::vector<std::pair<double, double>>& values, double level) {
    constexpr std::size_t kWindow = 151;
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        sum += values[i].second - (i >= kWindow ? values[i - kWindow].second : 0);
        if (i >= kWindow && sum > level * kWindow) return values[i - kWindow / 2].first;
    }
    return 1e300;
}

/// Where a line cuts a share off a disk of radius 1: distance from the centre.
double diskQuantile(double share) {
    double low = -1, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double t = (low + high) / 2;
        const double beyond = (std::acos(t) - t * std::sqrt(1 - t * t)) / M_PI;
        (beyond > share ? low : high) = t;
    }
    return low;
}

TEST(PcssTest, ThePenumbraOfAnEdgeIsAsWideAsParallelPlanesHaveIt) {
    for (const auto& [radius, height] : {std::pair(0.5, 1.5F), {0.5, 0.75F}, {0.25, 1.5F}}) {
        const auto run = runShadows(edgeScene(height), edgeSetup(radius));
        const auto values = profile(run);
        ASSERT_GT(values.size(), 4000U);
        const double low = crossing(values, 0.1), high = crossing(values, 0.9);
        const double receiver = 4, blocker = 4 - static_cast<double>(height);
        const double whole = 2 * radius * (receiver - blocker) / blocker;
        const double expected = whole * diskQuantile(0.1);
        std::printf("[ PENUMBRA ] light of %.1f m, edge %.2f m up: %.4f m, on paper %.4f\n",
                    2 * radius, static_cast<double>(height), high - low, expected);
        EXPECT_NEAR(high - low, expected, 0.1 * expected);
        EXPECT_NEAR((low + high) / 2, 0, 0.05 * whole);  // around the centre's hard shadow
    }
}

TEST(PcssTest, WithoutRotationVisibilityRisesInBandsAlongAnEdge) {
    auto setup = edgeSetup();
    setup.settings["pcss.filterTaps"] = "12";
    double falls[2] = {0, 0};
    for (const bool rotate : {false, true}) {
        setup.settings["pcss.rotate"] = rotate ? "true" : "false";
        const auto values = profile(runShadows(edgeScene(1.5F), setup));
        double most = 0;
        for (const auto& [x, visibility] : values) {
            falls[rotate] += std::max(most - visibility, 0.0);
            most = std::max(most, visibility);
        }
        falls[rotate] /= static_cast<double>(values.size());
    }
    EXPECT_LT(falls[0], 0.005);  // texels of the edge alone
    EXPECT_GT(falls[1], 0.02);
}

TEST(PcssTest, VisibilityComesInStepsOfAsManyFilterTapsAsSet) {
    auto setup = edgeSetup();
    for (const int taps : {1, 7, 96}) {
        setup.settings["pcss.filterTaps"] = std::to_string(taps);
        std::vector<int> steps;
        for (const auto& [x, visibility] : profile(runShadows(edgeScene(1.5F), setup))) {
            EXPECT_NEAR(visibility * taps, std::round(visibility * taps), 1e-4);
            steps.push_back(static_cast<int>(std::round(visibility * taps)));
        }
        std::sort(steps.begin(), steps.end());
        steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
        EXPECT_GT(static_cast<int>(steps.size()), taps * 4 / 5) << taps;
    }
}

TEST(PcssTest, OneBlockerTapSearchesWhereVogelsFirstPointLies) {
    // Turned lights have the tap on either side of the edge
    for (const char* up : {"0,0,1", "0,0,-1"}) {
        auto setup = edgeSetup(0.5, up);
        setup.settings = {{"pcss.blockerTaps", "1"}, {"pcss.rotate", "false"}};
        const auto run = runShadows(edgeScene(1.5F), setup);
        // Where the line to the tap's sample passes the near plane, the map looks from the centre
        const double sample = std::sqrt(0.5) * 0.5 * run.light.axisX.x;
        const double border = -sample * 4 * (1 / 1.5 - 1 / 4.0), spared = 0.012;
        std::size_t near = 0;
        for (const auto& [x, visibility] : profile(run)) {
            // Beyond the penumbra no filter tap is blocked, whatever the search finds
            if (std::abs(x - border) < spared || x > 0.28) continue;
            EXPECT_EQ(visibility < 1, x < border) << x << " of " << border;
            near += std::abs(x - border) < 3 * spared;
        }
        EXPECT_EQ(near > 50, border < 0) << near;
    }
    // 64 taps find the sheet wherever it covers some of the light
    for (const auto& [x, visibility] : profile(runShadows(edgeScene(1.5F), edgeSetup())))
        if (x < 0.22) {
            EXPECT_LT(visibility, 1) << x;
        }
}

TEST(PcssTest, BothPatternsGiveTheSameShadowFromOtherTaps) {
    auto setup = edgeSetup();
    setup.settings["pcss.pattern"] = "vogel";
    const auto vogel = profile(runShadows(edgeScene(1.5F), setup));
    setup.settings["pcss.pattern"] = "poisson";
    const auto poisson = profile(runShadows(edgeScene(1.5F), setup));
    ASSERT_EQ(vogel.size(), poisson.size());
    std::size_t differ = 0;
    double sum = 0;
    for (std::size_t i = 0; i < vogel.size(); ++i) {
        differ += vogel[i].second != poisson[i].second;
        sum += vogel[i].second - poisson[i].second;
    }
    EXPECT_GT(differ, vogel.size() / 20);
    EXPECT_LT(std::abs(sum) / static_cast<double>(vogel.size()), 0.003);
}

}  // namespace
}  // namespace penumbra::tests
