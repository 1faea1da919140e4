// SPDX-License-Identifier: MIT
#include "tests/reference/mlsm_run.h"

#include <bit>

#include "tests/support/fixtures.h"

namespace penumbra::tests {

std::vector<std::vector<MlsmList>> listsOf(const shared::MlsmParams& params,
                                           const std::vector<std::uint32_t>& lists,
                                           const std::vector<float>& fragments) {
    const auto values = static_cast<std::size_t>(MLSM_VALUES(params.channels));
    std::vector<std::vector<MlsmList>> result;
    for (int level = 0; level < params.levels; ++level) {
        auto& out = result.emplace_back();
        const int size = params.size[level];
        for (int i = 0; i < size * size; ++i) {
            const auto at = static_cast<std::size_t>(params.firstList[level] + i) * MLSM_LIST;
            auto& list = out.emplace_back();
            for (std::size_t f = lists[at]; f < lists[at + 1]; ++f) {
                const float* v = &fragments[f * values];
                MlsmFragment fragment{v[0], v[1], {v[1], v[1], v[1]}};
                if (params.channels == 3) fragment.taken = {v[2], v[3], v[4]};
                list.push_back(fragment);
            }
        }
    }
    return result;
}

MlsmUpload uploadOf(const std::vector<std::vector<MlsmList>>& lists, int channels) {
    MlsmUpload upload;
    const auto values = static_cast<std::size_t>(MLSM_VALUES(channels));
    for (const auto& level : lists)
        for (const auto& list : level) {
            const auto first = static_cast<std::uint32_t>(upload.fragments.size() / values);
            for (const auto& f : list) {
                upload.fragments.push_back(static_cast<float>(f.depth));
                upload.fragments.push_back(static_cast<float>(f.coverage));
                for (const double taken : f.taken)
                    if (channels == 3) upload.fragments.push_back(static_cast<float>(taken));
            }
            upload.lists.push_back(first);
            upload.lists.push_back(first + static_cast<std::uint32_t>(list.size()));
            const float nearest = list.empty() ? 0 : static_cast<float>(list[0].depth);
            upload.lists.push_back(std::bit_cast<std::uint32_t>(nearest));
        }
    if (upload.fragments.empty()) upload.fragments.resize(values);
    return upload;
}

MlsmRun runMlsm(const scene::Scene& original, const MlsmSetup& setup) {
    scene::Scene scene = original;
    scene.lights = {scene::parseLight(setup.light)};
    const auto bounds = scene::clipBounds(scene, {});
    const auto pose = scene::poseAt(scene, {}, 0);
    MlsmRun run;
    run.light = scene::lightsAt(scene, pose, bounds, {}).at(0);
    run.view =
        visibility::fitLightView(run.light, bounds, bounds.centre(), setup.settings.resolution, 1);
    geometry::Geometry geometry(program("frame"), scene, bounds.centre());
    const auto& mesh = geometry.run(pose);
    visibility::MlsmLists lists(program("frame"), program("mlsm"), setup.settings);
    visibility::MlsmFilter filter(program("mlsm"));
    runtime::Buffer<shared::MultiViewCounters> counters(device(), "counters", 1);
    run.levels = visibility::planMlsmLevels(setup.settings, setup.largest);
    auto& params = run.levels.params;
    params.channels = mesh.hasBlend ? 3 : 1;
    params.accumulate = setup.merge;
    params.epsilon = setup.settings.epsilon / run.view.params.focal;
    for (;; ++run.retries) {
        lists.run(mesh, run.view, params, counters);
        filter.run(run.levels, lists.map());
        if (!lists.grew()) break;
    }
    const auto heads = lists.map().lists.download();
    run.lists = listsOf(params, heads, lists.map().fragments.download());
    for (int level = 0; level < params.levels; ++level) {
        auto& out = run.nearest.emplace_back();
        for (int i = 0; i < params.size[level] * params.size[level]; ++i)
            out.push_back(std::bit_cast<float>(
                heads[static_cast<std::size_t>(params.firstList[level] + i) * MLSM_LIST + 2]));
    }
    return run;
}

bool sameLists(const MlsmRun& a, const MlsmRun& b) {
    if (a.lists.size() != b.lists.size()) return false;
    for (std::size_t level = 0; level < a.lists.size(); ++level)
        for (std::size_t i = 0; i < a.lists[level].size(); ++i) {
            const auto &p = a.lists[level][i], &q = b.lists[level][i];
            if (p.size() != q.size()) return false;
            for (std::size_t f = 0; f < p.size(); ++f)
                if (p[f].depth != q[f].depth || p[f].coverage != q[f].coverage ||
                    p[f].taken != q[f].taken)
                    return false;
        }
    return true;
}

}  // namespace penumbra::tests
