// SPDX-License-Identifier: MIT
#include "tests/reference/mlsm_filter_ref.h"

#include <algorithm>
#include <cmath>

namespace penumbra::tests {

MlsmFragment mlsmSumReference(int how, const MlsmFragment& sum, const MlsmFragment& more) {
    MlsmFragment result = sum;
    const auto each = [&](auto combine) {
        result.coverage = combine(sum.coverage, more.coverage);
        for (std::size_t c = 0; c < 3; ++c) result.taken[c] = combine(sum.taken[c], more.taken[c]);
    };
    if (how == MLSM_ADD) each([](double a, double b) { return a + b; });
    if (how == MLSM_MAX) each([](double a, double b) { return std::max(a, b); });
    if (how == MLSM_MULTIPLY) each([](double a, double b) { return 1 - (1 - a) * (1 - b); });
    if (how != MLSM_COVER) return result;
    const double beside = std::min(more.coverage, std::max(1 - sum.coverage, 0.0));
    result.coverage += beside;
    for (std::size_t c = 0; c < 3 && more.coverage > 0; ++c) {
        const double opacity = more.taken[c] / more.coverage;
        const double through = 1 - sum.taken[c] - beside * opacity;
        result.taken[c] = 1 - through * (1 - std::min(more.coverage - beside, 1.0) * opacity);
    }
    return result;
}

std::vector<MlsmList> mlsmMergeReference(const std::vector<MlsmList>& below, int belowSize,
                                         const shared::MlsmFilterParams& step, int size,
                                         double epsilon, int how) {
    std::vector<MlsmList> merged(static_cast<std::size_t>(size) * size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            std::vector<std::pair<MlsmFragment, std::size_t>> all;  // with the list's number
            std::size_t number = 0;
            for (const int ty : {step.tap0, step.tap1})
                for (const int tx : {step.tap0, step.tap1}) {
                    const int column = std::clamp(step.scale * x + tx, 0, belowSize - 1);
                    const int row = std::clamp(step.scale * y + ty, 0, belowSize - 1);
                    for (const auto& f : below[static_cast<std::size_t>(row * belowSize + column)])
                        all.emplace_back(f, number);
                    ++number;
                }
            std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
                return a.first.depth > b.first.depth;
            });
            auto& list = merged[static_cast<std::size_t>(y * size + x)];
            for (std::size_t i = 0; i < all.size();) {
                std::array<MlsmFragment, 4> sums{};
                MlsmFragment out;
                const double nearest = all[i].first.depth;
                double members = 0;
                for (; i < all.size() && all[i].first.depth >= nearest * (1 - epsilon);
                     ++i, ++members) {
                    auto& sum = sums[all[i].second];
                    sum = mlsmSumReference(how, sum, all[i].first);
                    out.depth += all[i].first.depth;
                }
                out.depth /= members;
                for (const auto& sum : sums) add(out, scaled(sum, 0.25));
                list.push_back(out);
            }
        }
    return merged;
}

}  // namespace penumbra::tests
