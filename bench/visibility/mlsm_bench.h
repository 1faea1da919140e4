// SPDX-License-Identifier: MIT
// Scenes and settings that the benchmarks of mlsm share.
#pragma once
#include "bench/support/technique_run.h"

namespace penumbra::bench {

inline SettingValues settingsOf(std::int64_t resolution, SettingValues more = {}) {
    more["mlsm.resolution"] = std::to_string(resolution);
    return more;
}

inline PosedScene& sceneOf(std::int64_t walls) {
    return walls ? wallScene() : builtinScene();
}

}  // namespace penumbra::bench
