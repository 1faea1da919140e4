// SPDX-License-Identifier: MIT
#include "host/visibility/mlsm_filter.h"

#include <algorithm>
#include <cmath>

namespace penumbra::visibility {
namespace {

/// What a level stands for, in base texels.
struct Level {
    int size = 1;
    double spacing = 1, origin = 0.5;
    double variance = 0;  ///< of the box that its lists are means of
    /// Width of the box with the variance of the level's box and of the tent that bilinear reads
    /// put over it: a box of width f has f^2 / 12, a tent of spacing s s^2 / 6.
    double width() const { return std::sqrt(12 * variance + 2 * spacing * spacing); }
};

/// The step to the next level, and that level [MLSM] figure 7.
shared::MlsmFilterParams stepTo(int number, int stackFrom, bool subsample, Level& level) {
    shared::MlsmFilterParams step{};
    step.level = number;
    step.subsample = subsample ? 1 : 0;
    double apart = 1;  // between the two lists along a side, of the level below
    if (level.size > stackFrom && level.origin > 0) {
        step.scale = 2;
        step.tap1 = 1;
    } else if (level.origin > 0) {  // first of the stack: one list wider, half a list earlier
        step.scale = 1;
        step.tap0 = -1;
    } else {
        // Half the distance grows with each level of the stack
        const int half = std::max(static_cast<int>(std::exp2(number - 1) / level.spacing) / 2, 1);
        step.scale = 1;
        step.tap0 = -half;
        step.tap1 = half;
        apart = 2 * half;
    }
    if (!subsample) level.variance += std::pow(apart * level.spacing / 2, 2);
    if (step.scale == 2) {
        level.size = (level.size + 1) / 2;
        level.spacing *= 2;
        level.origin *= 2;
    } else if (step.tap1 == 0) {
        level.size += 1;
        level.origin = 0;
    }
    return step;
}

}  // namespace

MlsmLevels planMlsmLevels(const MlsmSettings& settings, double largest) {
    MlsmLevels levels;
    auto& p = levels.params;
    p.resolution = settings.resolution;
    p.layers = settings.layers;
    p.join = settings.join ? 1 : 0;
    Level level{settings.resolution};
    for (;;) {
        const int i = p.levels++;
        p.firstList[i] = static_cast<int>(levels.lists);
        p.size[i] = level.size;
        p.spacing[i] = static_cast<float>(level.spacing);
        p.origin[i] = static_cast<float>(level.origin);
        p.width[i] = static_cast<float>(level.width());
        levels.lists += static_cast<std::uint64_t>(level.size) * level.size;
        const bool covers = std::exp2(i) >= settings.resolution;
        if (covers || i >= settings.maxLevel || i + 1 >= MLSM_MAX_LEVELS ||
            level.width() >= largest)
            return levels;
        levels.steps.push_back(
            stepTo(i + 1, settings.stackFrom, i < settings.subsampleLevels, level));
    }
}

MlsmFilter::MlsmFilter(const runtime::Program& mlsm)
    : filter_(mlsm, "mlsm_filter"), colour_(mlsm, "mlsm_filter_colour") {}

void MlsmFilter::run(const MlsmLevels& levels, MlsmMap& map) {
    Merge& merge = levels.params.channels == 1 ? filter_ : colour_;
    for (const auto& step : levels.steps) {
        const auto size = static_cast<std::uint64_t>(levels.params.size[step.level]);
        merge.launch({size * size}, {64}, levels.params, step, map.lists, map.fragments,
                     *map.total);
    }
}

}  // namespace penumbra::visibility
