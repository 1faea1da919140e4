// SPDX-License-Identifier: MIT
// Levels of lists: merged as the twin has it, sorted, and as wide as they say.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/reference/mlsm_run.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

using runtime::Buffer;
using visibility::MlsmLevels;
using visibility::MlsmSettings;
using visibility::planMlsmLevels;

MlsmSettings settingsOf(int resolution, int stackFrom) {
    MlsmSettings settings;
    settings.resolution = resolution;
    settings.stackFrom = stackFrom;
    return settings;
}

/// A base level of random lists, some empty, some of dozens.
std::vector<MlsmList> randomLists(unsigned seed, int size, bool coloured) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<MlsmList> lists(static_cast<std::size_t>(size) * size);
    for (auto& list : lists) {
        const int length = random() % 4 == 0 ? 0 : static_cast<int>(random() % 6);
        for (int i = 0; i < (random() % 40 == 0 ? 30 : length); ++i) {
            MlsmFragment f;
            f.depth = 0.2F + 0.7F * unit(random);
            f.coverage = random() % 3 ? 1 : unit(random);
            f.taken = {f.coverage, f.coverage, f.coverage};
            for (auto& taken : f.taken)
                if (coloured) taken = static_cast<float>(f.coverage * unit(random));
            list.push_back(f);
        }
        std::sort(list.begin(), list.end(),
                  [](const auto& a, const auto& b) { return a.depth > b.depth; });
    }
    return lists;
}

/// All levels from a base level.
std::vector<std::vector<MlsmList>> filtered(const std::vector<MlsmList>& base, MlsmLevels levels,
                                            int channels, int how, float epsilon) {
    auto& p = levels.params;
    p.channels = channels;
    p.accumulate = how;
    p.epsilon = epsilon;
    p.capacity = 1 << 20;
    auto upload = uploadOf({base}, channels);
    const auto count = static_cast<std::uint32_t>(upload.fragments.size()) / MLSM_VALUES(channels);
    upload.lists.resize(MLSM_LIST * levels.lists);
    upload.fragments.resize(static_cast<std::size_t>(p.capacity) * MLSM_VALUES(channels));
    Buffer<std::uint32_t> total(device(), "total", std::vector<std::uint32_t>{count});
    visibility::MlsmMap map;
    map.lists = Buffer<std::uint32_t>(device(), "lists", upload.lists);
    map.fragments = Buffer<float>(device(), "fragments", upload.fragments);
    map.total = &total;
    visibility::MlsmFilter filter(program("mlsm"));
    filter.run(levels, map);
    EXPECT_LE(total.download()[0], p.capacity);
    return listsOf(p, map.lists.download(), map.fragments.download());
}

double totalOf(const std::vector<MlsmList>& lists) {
    double sum = 0;
    for (const auto& list : lists)
        for (const auto& f : list) sum += f.coverage;
    return sum;
}

class MlsmFilterTest : public testing::TestWithParam<int> {};

TEST_P(MlsmFilterTest, EachLevelIsTheTwinOfTheOneBelow) {
    std::size_t compared = 0, wrong = 0;
    for (const int channels : {1, 3})
        for (const auto& [size, stackFrom] :
             {std::pair(32, 0), std::pair(32, 8), std::pair(27, 7)}) {
            const auto levels = planMlsmLevels(settingsOf(size, stackFrom), 1e9);
            const float epsilon = 0.02F;
            const auto device = filtered(randomLists(7, size, channels == 3), levels, channels,
                                         GetParam(), epsilon);
            for (std::size_t k = 1; k < device.size(); ++k) {
                const auto twin = mlsmMergeReference(
                    device[k - 1], levels.params.size[k - 1], levels.steps[k - 1],
                    levels.params.size[k], epsilon * std::exp2(static_cast<double>(k)), GetParam());
                ASSERT_EQ(device[k].size(), twin.size());
                for (std::size_t i = 0; i < twin.size(); ++i) {
                    ++compared;
                    if (device[k][i].size() != twin[i].size()) {
                        ++wrong;  // a fragment lies at the end of an interval
                        continue;
                    }
                    for (std::size_t f = 0; f < twin[i].size(); ++f) {
                        ASSERT_NEAR(device[k][i][f].depth, twin[i][f].depth, 1e-6);
                        ASSERT_NEAR(device[k][i][f].coverage, twin[i][f].coverage, 1e-4);
                        for (std::size_t c = 0; c < 3; ++c)
                            ASSERT_NEAR(device[k][i][f].taken[c], twin[i][f].taken[c], 1e-4);
                    }
                }
            }
        }
    EXPECT_GT(compared, 2500U);
    EXPECT_LE(wrong, compared / 500);
}

INSTANTIATE_TEST_SUITE_P(Accumulations, MlsmFilterTest,
                         testing::Values(MLSM_ADD, MLSM_MULTIPLY, MLSM_MAX, MLSM_COVER));

TEST(MlsmLevelsTest, ListsStaySortedAndAdditionKeepsTheirOpacity) {
    const auto base = randomLists(3, 32, false);
    for (const int stackFrom : {0, 8}) {
        const auto levels = planMlsmLevels(settingsOf(32, stackFrom), 1e9);
        const auto lists = filtered(base, levels, 1, MLSM_ADD, 0.02F);
        for (std::size_t k = 0; k < lists.size(); ++k) {
            for (const auto& list : lists[k])
                for (std::size_t f = 1; f < list.size(); ++f)
                    ASSERT_LE(list[f].depth, list[f - 1].depth);
            // The mean over the map; a stack repeats its border, a pyramid does not
            if (stackFrom == 0) {
                EXPECT_NEAR(totalOf(lists[k]) / static_cast<double>(lists[k].size()),
                            totalOf(base) / 1024, 1e-3);
            }
        }
    }
}

TEST(MlsmLevelsTest, LevelsOfAConstantMapAreConstant) {
    const MlsmList constant = {{0.75, 1, {1, 1, 1}}, {0.5, 0.25, {0.25, 0.25, 0.25}}};
    for (const auto& [size, stackFrom] : {std::pair(32, 0), std::pair(32, 8), std::pair(23, 6)}) {
        const auto levels = planMlsmLevels(settingsOf(size, stackFrom), 1e9);
        const auto lists =
            filtered(std::vector<MlsmList>(static_cast<std::size_t>(size) * size, constant), levels,
                     1, MLSM_COVER, 0.002F);
        for (const auto& level : lists)
            for (const auto& list : level) {
                ASSERT_EQ(list.size(), 2U);
                EXPECT_EQ(list[0].depth, 0.75);
                EXPECT_EQ(list[1].coverage, 0.25);
            }
    }
}

TEST(MlsmLevelsTest, EmptyListsStayEmpty) {
    const auto levels = planMlsmLevels(settingsOf(16, 4), 1e9);
    for (const auto& level : filtered(std::vector<MlsmList>(256), levels, 1, MLSM_ADD, 0.01F))
        for (const auto& list : level) EXPECT_TRUE(list.empty());
}

TEST(MlsmLevelsTest, APlaneKeepsItsDepthAtEveryLevel) {
    // near / z of a plane is linear over the map: a list's mean is the depth at its centre
    std::vector<MlsmList> base;
    for (int i = 0; i < 64 * 64; ++i)
        base.push_back({{0.5 + 0.001 * (i % 64) + 0.002 * (i / 64), 1, {1, 1, 1}}});
    const auto levels = planMlsmLevels(settingsOf(64, 16), 1e9);
    const auto lists = filtered(base, levels, 1, MLSM_COVER, 1);
    const auto& p = levels.params;
    for (int level = 1; level < 5; ++level)
        for (int y = 0; y < p.size[level]; ++y)
            for (int x = 0; x < p.size[level]; ++x) {
                const double column = p.origin[level] + x * p.spacing[level] - 0.5;
                const double row = p.origin[level] + y * p.spacing[level] - 0.5;
                const double half = std::exp2(level) / 2;  // whose box the map's border cuts
                if (column < half || row < half || column > 63 - half || row > 63 - half) continue;
                const auto& list = lists[static_cast<std::size_t>(level)]
                                        [static_cast<std::size_t>(y * p.size[level] + x)];
                ASSERT_EQ(list.size(), 1U);
                EXPECT_NEAR(list[0].depth, 0.5 + 0.001 * column + 0.002 * row, 1e-6);
            }
}

TEST(MlsmLevelsTest, AStackIsOneListWiderAndItsListsAreAsWideAsTheirLevel) {
    // One covered texel: where it is found, and how often, is the box of each level
    const int size = 64, at = 37;
    std::vector<MlsmList> base(static_cast<std::size_t>(size) * size);
    base[static_cast<std::size_t>(at * size + at)] = {{0.5, 1, {1, 1, 1}}};
    const auto levels = planMlsmLevels(settingsOf(size, 16), 1e9);
    const auto lists = filtered(base, levels, 1, MLSM_ADD, 0.01F);
    const auto& p = levels.params;
    const int sizes[] = {64, 32, 16, 17, 17, 17, 17};
    ASSERT_EQ(p.levels, 7);
    for (int level = 0; level < 6; ++level) {
        ASSERT_EQ(p.size[level], sizes[level]);
        const double width = std::exp2(level);
        for (int x = 0; x < p.size[level]; ++x) {
            const double centre = p.origin[level] + x * p.spacing[level];
            const bool inside = std::abs(at + 0.5 - centre) < width / 2;
            double row = 0;
            for (int y = 0; y < p.size[level]; ++y)
                for (const auto& f : lists[static_cast<std::size_t>(level)]
                                          [static_cast<std::size_t>(y * p.size[level] + x)])
                    row += f.coverage;
            // Rows within the box times a texel's share of it
            EXPECT_NEAR(row, inside ? width / p.spacing[level] / (width * width) : 0, 1e-6)
                << "level " << level << " column " << x;
        }
    }
}

TEST(MlsmLevelsTest, OnlyLevelsThatFiltersNeedAreMade) {
    EXPECT_EQ(planMlsmLevels(settingsOf(1024, 128), 0).params.levels, 1);
    EXPECT_EQ(planMlsmLevels(settingsOf(1024, 0), 1e9).params.levels, 11);
    const auto some = planMlsmLevels(settingsOf(1024, 128), 100);
    EXPECT_GE(some.params.width[some.params.levels - 1], 100);
    EXPECT_LT(some.params.width[some.params.levels - 2], 100);
    auto five = settingsOf(1024, 128);
    five.maxLevel = 4;
    EXPECT_EQ(planMlsmLevels(five, 1e9).params.levels, 5);
}

TEST(MlsmLevelsTest, SubsampledLevelsReferToListsOfTheBaseLevel) {
    auto settings = settingsOf(16, 0);
    settings.subsampleLevels = 2;
    const auto base = randomLists(9, 16, false);
    const auto lists = filtered(base, planMlsmLevels(settings, 1e9), 1, MLSM_ADD, 0.02F);
    for (std::size_t level = 1; level < 3; ++level) {
        const std::size_t side = 16U >> level;
        for (std::size_t i = 0; i < lists[level].size(); ++i) {
            bool found = false;
            for (std::size_t k = 0; k < (1U << (2 * level)); ++k) {
                const std::size_t x = ((i % side) << level) + (k & ((1U << level) - 1));
                const std::size_t y = ((i / side) << level) + (k >> level);
                const auto& one = base[16 * y + x];
                bool same = one.size() == lists[level][i].size();
                for (std::size_t f = 0; f < one.size() && same; ++f)
                    same = one[f].depth == lists[level][i][f].depth;
                found |= same;
            }
            EXPECT_TRUE(found) << "level " << level << " list " << i;
        }
    }
}

}  // namespace
}  // namespace penumbra::tests
