// SPDX-License-Identifier: MIT
// Settings of filtered multi-layer shadow maps.
#pragma once
#include "host/visibility/multi_view_settings.h"

namespace penumbra::visibility {

/// automatic: back faces of edge-closed meshes that are opaque, both faces of all others.
enum class Faces { automatic, back, front, all };
enum class ListBuild { array, list };
enum class Accumulate { add, multiply, max, cover };  // MLSM_*

struct MlsmSettings : MapSettings, BiasSettings {
    Faces faces = Faces::automatic;
    ListBuild build = ListBuild::array;
    int layers = 0;
    bool join = false;
    float epsilon = 2;
    Accumulate accumulateMerge = Accumulate::cover, accumulateLookup = Accumulate::add;
    int stackFrom = 128;
    int maxLevel = 13;
    int subsampleLevels = 0;
    bool antialias = false;
    /// Fragments lie on their surfaces at the texels' centres: no slope is needed.
    MlsmSettings() { slopeBias = 0; }

    template <typename Row>
    void rows(Row& row) {
        pixelRows(row);
        row.choice("faces", faces, {"auto", "back", "front", "all"},
                   "faces that are kept; auto: back faces of edge-closed opaque meshes, both of all "
                   "others");
        row.choice("build", build, {"array", "list"},
                   "of the base level: counted, then filled, or by linked lists; never changes the "
                   "image",
                   false);
        row.number("layers", layers, 0, 65536, "fragments",
                   "kept in each list of the base level, from the light on; 0: all");
        row.flag("join", join, "join fragments within epsilon at the base level already");
        row.number("epsilon", epsilon, 0.0F, 4096.0F, "texels",
                   "depth within which fragments are merged, in texels of their level");
        row.choice("accumulateMerge", accumulateMerge, {"add", "multiply", "max", "cover"},
                   "opacities of one list as lists are merged; cover: added until all is covered");
        row.choice("accumulateLookup", accumulateLookup, {"add", "multiply"},
                   "opacities before a receiver: occluders beside one another, or overlapping ones");
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

}  // namespace penumbra::visibility
