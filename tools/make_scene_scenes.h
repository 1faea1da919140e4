// SPDX-License-Identifier: MIT
// The scenes by name.
#pragma once

#include <string_view>

#include "make_scene_gltf.h"

namespace tools {

void makeBuiltin(GltfWriter& writer);

// The scenes measured in [VWSS] tables 1 and 2 (challenger, volund, warriors, cliffside) and [MVSS]
// table 1 (mvss2, mvss6), rebuilt: same numbers of triangles and, for [VWSS], of points.
void makeChallenger(GltfWriter& writer);
void makeVolund(GltfWriter& writer);
void makeWarriors(GltfWriter& writer);
void makeCliffside(GltfWriter& writer);
void makeMvss2(GltfWriter& writer);
void makeMvss6(GltfWriter& writer);

// The scenes of [4DR] (figures 1 and 5, section 4), rebuilt: same numbers of triangles, diagonals
// and distances of the light.
void makeTree(GltfWriter& writer);
void makeTower(GltfWriter& writer);
void makeToys(GltfWriter& writer);
void makeDragon(GltfWriter& writer);
void makeCoaster(GltfWriter& writer);
void makeChurch(GltfWriter& writer);

// Stand-ins for the scenes of [MLSM]: its figures 1, 11, 12, 16 and 17, made for what they show.
void makeHall(GltfWriter& writer);
void makeStreet(GltfWriter& writer);
void makeFoliage(GltfWriter& writer);
void makeFence(GltfWriter& writer);
void makeWindow(GltfWriter& writer);

struct NamedScene {
    std::string_view name;
    void (*make)(GltfWriter&);
};

inline constexpr NamedScene kScenes[] = {
    {"builtin", makeBuiltin},     {"challenger", makeChallenger},
    {"volund", makeVolund},       {"warriors", makeWarriors},
    {"cliffside", makeCliffside}, {"mvss2", makeMvss2},
    {"mvss6", makeMvss6},         {"tree", makeTree},
    {"tower", makeTower},         {"toys", makeToys},
    {"dragon", makeDragon},       {"coaster", makeCoaster},
    {"church", makeChurch},       {"hall", makeHall},
    {"street", makeStreet},       {"foliage", makeFoliage},
    {"fence", makeFence},         {"window", makeWindow},
};

}  // namespace tools
