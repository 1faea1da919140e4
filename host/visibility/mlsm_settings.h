// SPDX-License-Identifier: MIT
// Settings of filtered multi-layer shadow maps.
#pragma once
#include "host/visibility/multi_view_settings.h"
#include "kernels/shared/mlsm.h"

namespace penumbra::visibility {

/// automatic: back faces of edge-closed meshes that are opaque, both faces of all others.
enum class Faces { automatic, back, front, all };
enum class ListBuild { array, list };
/// automatic: leaves and other alpha-tested surfaces overlap at random, so that opacities multiply
/// where there are any; solids are added up, until all is covered.
enum class Accumulate { automatic, add, multiply, max, cover };

struct MlsmSettings : MapSettings, BiasSettings {
    Faces faces = Faces::automatic;
    ListBuild build = ListBuild::array;
    int layers = 0;
    bool join = false;
    float epsilon = 2;
    Accumulate accumulateMerge = Accumulate::automatic, accumulateLookup = Accumulate::automatic;
    int stackFrom = 128;
    int maxLevel = 13;
    int subsampleLevels = 0;
    bool antialias = false;
    /// Fragments lie on their surfaces at the texels' centres: no slope is needed.
    MlsmSettings() { slopeBias = 0; }

    template <typename Row>
    void rows(Row& row) {
        pixelRows(row);
        row.choice(
            "faces", faces, {"auto", "back", "front", "all"},
            "faces that are kept; auto: back faces of edge-closed opaque meshes with nothing "
            "inside, both of all others");
        row.choice("build", build, {"array", "list"},
                   "of the base level: counted, then filled, or by linked lists; never changes the "
                   "image",
                   false);
        row.number("layers", layers, 0, 65536, "fragments",
                   "kept in each list of the base level, from the light on; 0: all");
        row.flag("join", join, "join fragments within epsilon at the base level already");
        row.number("epsilon", epsilon, 0.0F, 4096.0F, "texels",
                   "depth within which fragments are merged, in texels of their level");
        row.choice("accumulateMerge", accumulateMerge, {"auto", "add", "multiply", "max", "cover"},
                   "opacities of one list as lists are merged; cover: added until all is covered; "
                   "auto: multiply where anything is alpha-tested, else cover");
        row.choice(
            "accumulateLookup", accumulateLookup, {"auto", "add", "multiply"},
            "opacities before a receiver: occluders beside one another, or overlapping ones; "
            "auto: multiply where anything is alpha-tested, else add");
        row.number("stackFrom", stackFrom, 0, 8192, "texels",
                   "levels of this size and smaller become a stack of equal size (Y-map); 0: none");
        row.number("maxLevel", maxLevel, 0, 13, "",
                   "coarsest level: limits the filter's size to about its power of 2, in texels");
        row.number("subsampleLevels", subsampleLevels, 0, 13, "",
                   "first levels that refer to lists of the base level instead of merging them");
        row.flag("antialias", antialias, "filters are at least as wide as the pixel");
        BiasSettings::rows(row);
    }
};

/// MLSM_* of a setting; `fallback`: what automatic means for a scene of solids.
inline int accumulationOf(Accumulate how, bool hasMask, int fallback) {
    if (how == Accumulate::automatic) return hasMask ? MLSM_MULTIPLY : fallback;
    return static_cast<int>(how) - 1;
}

}  // namespace penumbra::visibility
