// SPDX-License-Identifier: MIT
// Lookup of receivers against the twin, on random lists and random planes.
#include "host/visibility/mlsm_lookup.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "kernels/shared/gbuffer.h"
#include "tests/reference/mlsm_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using visibility::MlsmLevels;

constexpr int kReceivers = 301, kResolution = 32;

struct Variant {
    const char* name;
    int channels, parts;
    bool multiply;
    double halfSize;
    int stackFrom;
};

/// Levels of a few surfaces at random depths, and receivers on random planes behind most of them.
struct Case {
    Case(unsigned seed, const Variant& v) : random(seed), variant(v) {
        view = {0.6, 1.1, v.halfSize * v.parts, v.halfSize, kResolution};
        visibility::MlsmSettings settings;
        settings.resolution = kResolution;
        settings.stackFrom = v.stackFrom;
        reference.reach = 2 * v.halfSize * view.focal() / view.near;
        reference.parts = v.parts;
        reference.stepX = v.parts > 1 ? 1 : 0;
        reference.multiply = v.multiply;
        levels = visibility::planMlsmLevels(settings, reference.reach);
        levels.params.channels = v.channels;
        lists.push_back(surfaces());
        for (std::size_t k = 1; k < static_cast<std::size_t>(levels.params.levels); ++k)
            lists.push_back(mlsmMergeReference(
                lists[k - 1], levels.params.size[k - 1], levels.steps[k - 1], levels.params.size[k],
                0.01 * std::exp2(static_cast<double>(k)), MLSM_COVER));
        // What the device stores is what the twin reads
        for (auto& level : lists)
            for (auto& list : level)
                for (auto& f : list) {
                    f.depth = static_cast<float>(f.depth);
                    f.coverage = static_cast<float>(f.coverage);
                    for (auto& taken : f.taken)
                        taken = v.channels == 1 ? f.coverage : static_cast<float>(taken);
                }
        for (int i = 0; i < kReceivers; ++i) receivers.push_back(receiver());
    }
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    std::vector<MlsmList> surfaces() {
        std::vector<MlsmList> base(kResolution * kResolution);
        for (int s = 0; s < 7; ++s) {
            const double depth = between(0.3, 0.95), slope = between(-0.004, 0.004);
            const int left = static_cast<int>(between(-4, 26)),
                      top = static_cast<int>(between(-4, 26));
            const std::array<double, 3> opacity{between(0.2, 1), between(0.2, 1), between(0.2, 1)};
            const bool glass = variant.channels == 3 && s % 2;
            for (int y = std::max(top, 0); y < std::min(top + 14, kResolution); ++y)
                for (int x = std::max(left, 0); x < std::min(left + 14, kResolution); ++x) {
                    MlsmFragment f{depth + slope * (x + y - left - top), 1, {1, 1, 1}};
                    if (glass) f.taken = opacity;
                    base[static_cast<std::size_t>(y * kResolution + x)].push_back(f);
                }
        }
        for (auto& list : base)
            std::sort(list.begin(), list.end(),
                      [](const auto& a, const auto& b) { return a.depth > b.depth; });
        return base;
    }
    PlaneReceiver receiver() {
        PlaneReceiver r;
        const double z = view.near / between(0.15, 0.6);
        r.origin = {0.5 * z * between(-1, 1), 0.5 * z * between(-1, 1), z};
        r.normal = glm::normalize(glm::dvec3{between(-0.5, 0.5), between(-0.5, 0.5), -1});
        if (receivers.size() % 9 == 0)  // partly below its own horizon
            r.normal = glm::normalize(
                glm::cross(r.origin - glm::dvec3(between(-0.1, 0.1), 0, 0), glm::dvec3(0, 1, 0.2)));
        if (glm::dot(r.normal, r.origin) > 0) r.normal = -r.normal;
        return r;
    }
    std::mt19937 random;
    Variant variant;
    ViewGeometry view;
    MlsmLookupReference reference;
    MlsmLevels levels;
    std::vector<std::vector<MlsmList>> lists;
    std::vector<PlaneReceiver> receivers;
};

std::vector<float> planesOf(const Case& c, std::size_t stride) {
    std::vector<float> planes(RECEIVER_PLANES * stride, 0.0F);
    const double middle = 0.5 * c.view.resolution;
    for (std::size_t i = 0; i < c.receivers.size(); ++i) {
        const auto& r = c.receivers[i];
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

/// Visibility [channels, stride].
std::vector<double> deviceVisibility(const Case& c, std::size_t stride) {
    visibility::LightView view;
    view.params.resolution = kResolution;
    view.params.near = static_cast<float>(c.view.near);
    view.params.focal = static_cast<float>(c.view.focal());
    view.params.halfWidth = static_cast<float>(c.view.halfWidth);
    view.params.halfHeight = static_cast<float>(c.view.halfHeight);
    visibility::MlsmReach reach;
    reach.size = c.reference.reach;
    reach.stepX = c.reference.stepX;
    reach.parts = c.reference.parts;
    const auto upload = uploadOf(c.lists, c.variant.channels);
    visibility::MlsmMap map;
    map.lists = Buffer<std::uint32_t>(device(), "lists", upload.lists);
    map.fragments = Buffer<float>(device(), "fragments", upload.fragments);
    visibility::ReceiverImage receivers;
    receivers.width = receivers.onScreen = kReceivers;
    receivers.stride = static_cast<int>(stride);
    receivers.planes = Buffer<float>(device(), "receivers", planesOf(c, stride));
    const auto channels = static_cast<std::size_t>(c.variant.channels);
    receivers.hidden = Buffer<std::uint32_t>(device(), "hidden", channels * stride);
    receivers.hidden.fill(0);
    visibility::MlsmLookup lookup(program("mlsm"), {});
    lookup.run(view, reach, c.variant.multiply ? MLSM_MULTIPLY : MLSM_ADD, c.levels.params, map,
               receivers);
    std::vector<double> result;
    for (const auto hidden : receivers.hidden.download())
        result.push_back(1 - hidden / static_cast<double>(MLSM_WEIGHT));
    return result;
}

class MlsmLookupTest : public testing::TestWithParam<Variant> {};

TEST_P(MlsmLookupTest, VisibilityEqualsTheTwin) {
    const auto stride = static_cast<std::size_t>(shared::gbufferStride(kReceivers));
    std::size_t compared = 0, wrong = 0, dark = 0, partly = 0;
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const Case c(seed, GetParam());
        const auto device = deviceVisibility(c, stride);
        for (std::size_t i = 0; i < c.receivers.size(); ++i) {
            const auto twin =
                mlsmVisibilityReference(c.receivers[i], c.view, c.levels, c.lists, c.reference);
            for (std::size_t k = 0; k < static_cast<std::size_t>(c.variant.channels); ++k) {
                ++compared;
                wrong += std::abs(device[k * stride + i] - twin[k]) > 4e-3;
                dark += twin[k] < 0.05;
                partly += twin[k] >= 0.05 && twin[k] <= 0.95;
            }
        }
        for (std::size_t i = c.receivers.size(); i < stride; ++i) EXPECT_EQ(device[i], 1);
    }
    std::printf("[ LOOKUP   ] %zu compared, %zu dark, %zu partly, %zu differ\n", compared, dark,
                partly, wrong);
    // Which fragments are one surface, and which lie before a receiver, is decided by float
    EXPECT_LE(wrong, compared / 100);
    EXPECT_GT(dark, compared / 50);
    EXPECT_GT(partly, compared / 10);
}

INSTANTIATE_TEST_SUITE_P(Variants, MlsmLookupTest,
                         testing::Values(Variant{"Pyramid", 1, 1, false, 0.15, 0},
                                         Variant{"Stack", 1, 1, false, 0.3, 8},
                                         Variant{"Multiply", 1, 1, true, 0.2, 8},
                                         Variant{"Parts", 1, 3, false, 0.1, 8},
                                         Variant{"Colour", 3, 1, false, 0.2, 8},
                                         Variant{"ColourMultiply", 3, 1, true, 0.2, 0},
                                         Variant{"Point", 1, 1, false, 0, 8}),
                         [](const auto& test) { return test.param.name; });

/// Visibility of receivers at given depths below the middle of one list everywhere.
std::vector<double> below(const MlsmList& list, const std::vector<double>& depths,
                          double halfSize) {
    Case c(1, {"", 1, 1, false, halfSize, 0});
    c.lists[0].assign(c.lists[0].size(), list);
    for (std::size_t k = 1; k < c.lists.size(); ++k) c.lists[k].assign(c.lists[k].size(), list);
    c.receivers.clear();
    for (const double depth : depths)
        c.receivers.push_back({{0, 0, c.view.near / depth}, {0, 0, -1}});
    const auto stride = static_cast<std::size_t>(shared::gbufferStride(kReceivers));
    auto result = deviceVisibility(c, stride);
    result.resize(depths.size());
    return result;
}

TEST(MlsmLookupPlacesTest, BeforeTheFirstBetweenAndBehindTheLastFragment) {
    const MlsmList list = {{0.8, 0.25, {0.25, 0.25, 0.25}}, {0.5, 0.5, {0.5, 0.5, 0.5}}};
    for (const double halfSize : {0.0, 0.05, 0.3}) {
        const auto seen = below(list, {0.9, 0.6, 0.3}, halfSize);
        EXPECT_NEAR(seen[0], 1, 1e-4) << halfSize;
        EXPECT_NEAR(seen[1], 0.75, 1e-4) << halfSize;
        EXPECT_NEAR(seen[2], 0.25, 1e-4) << halfSize;
    }
}

TEST(MlsmLookupPlacesTest, EmptyListsAreLit) {
    for (const double seen : below({}, {0.9, 0.5, 0.1}, 0.2)) EXPECT_EQ(seen, 1);
}

TEST(MlsmReachTest, LightsAreCutIntoSquares) {
    visibility::LightView view;
    view.params.focal = 100;
    view.params.near = 2;
    const auto reachOf = [&](float width, float height, bool disk) {
        view.params.halfWidth = width / 2;
        view.params.halfHeight = height / 2;
        view.disk = disk;
        return visibility::mlsmReachOf(view);
    };
    EXPECT_NEAR(reachOf(1, 1, false).size, 50, 1e-4);
    EXPECT_NEAR(reachOf(1, 1, true).size, 50 * std::sqrt(M_PI) / 2, 1e-4);
    EXPECT_EQ(reachOf(0, 0, false).size, 0);
    const auto wide = reachOf(3, 1, false), high = reachOf(1, 3, false);
    EXPECT_EQ(wide.parts, 3);
    EXPECT_NEAR(wide.size, 50, 1e-4);
    EXPECT_NEAR(wide.stepX, 1, 1e-6);
    EXPECT_EQ(wide.stepY, 0);
    EXPECT_EQ(high.stepX, 0);
    EXPECT_NEAR(high.stepY, 1, 1e-6);
    EXPECT_EQ(reachOf(1.3F, 1, false).parts, 1);
    EXPECT_EQ(reachOf(1, 0, false).parts, MLSM_MAX_PARTS);
}

}  // namespace
}  // namespace penumbra::tests
