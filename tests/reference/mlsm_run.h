// SPDX-License-Identifier: MIT
// Runs geometry, lists and filter for a scene at rest and one light, and brings lists to the host.
#pragma once
#include "host/scene/animation.h"
#include "host/scene/bounds.h"
#include "host/visibility/mlsm_filter.h"
#include "tests/reference/mlsm_filter_ref.h"
#include "tests/reference/mlsm_lists_ref.h"
#include "tests/reference/mlsm_lookup_ref.h"

namespace penumbra::tests {

struct MlsmSetup {
    std::string light = "rect:at=0.3,6,-0.4;aim=0,0,0;up=0,0,1;size=1x1;radiance=10";
    visibility::MlsmSettings settings;
    double largest = 1e9;  ///< filter size that levels are made for
    int merge = MLSM_ADD;
};

struct MlsmRun {
    scene::AreaLight light;
    visibility::LightView view;
    visibility::MlsmLevels levels;
    std::vector<std::vector<MlsmList>> lists;  ///< [level][row, column]
    std::vector<std::vector<float>> nearest;   ///< [level]: depth that skipping relies on
    int retries = 0;
};

MlsmRun runMlsm(const scene::Scene& scene, const MlsmSetup& setup);

/// Lists as the kernels read them.
struct MlsmUpload {
    std::vector<std::uint32_t> lists;
    std::vector<float> fragments;
};
MlsmUpload uploadOf(const std::vector<std::vector<MlsmList>>& lists, int channels);

/// Lists of all levels from device memory.
std::vector<std::vector<MlsmList>> listsOf(const shared::MlsmParams& params,
                                           const std::vector<std::uint32_t>& lists,
                                           const std::vector<float>& fragments);

/// True if all lists hold the same fragments to the bit.
bool sameLists(const MlsmRun& a, const MlsmRun& b);

}  // namespace penumbra::tests
