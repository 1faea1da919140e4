// SPDX-License-Identifier: MIT
// Settings that techniques with depth maps share.
#pragma once
#include "host/settings.h"

namespace penumbra::visibility {

enum class Pcf { one, five, nine, bilinear };
enum class Outside { raytrace, lit };

/// Depth maps and the pixels that are tested against them.
struct MapSettings {
    int resolution = 1024;
    int depthBits = 32;
    int viewsPerBatch = 0;
    bool halfResolution = false;
    Outside outside = Outside::raytrace;
    bool skipLit = true;

    template <typename Row>
    void pixelRows(Row& row) {
        row.number("resolution", resolution, 64, 8192, "texels", "side of each depth map");
        row.choice(
            "outside", outside, {"raytrace", "lit"},
            "receivers that some view does not hold, where the views cannot hold all casters");
        row.flag("halfResolution", halfResolution,
                 "test every other pixel of every other row; the rest by edge-aware upsampling");
    }
    template <typename Row>
    void rows(Row& row) {
        pixelRows(row);
        row.oneOf("depthBits", depthBits, {16, 32}, "bits", "of a depth map's texel");
        row.number("viewsPerBatch", viewsPerBatch, 0, 4096, "views",
                   "maps held at a time; 0: by device and memory; never changes the image", false);
        row.flag("skipLit", skipLit,
                 "leave out receivers that no caster can shadow; never changes the image", false);
    }
};

/// How far shadow tests start off the receiver.
struct BiasSettings {
    float bias = 0;
    float constantBias = 0.25F;
    float slopeBias = 1.1F;

    template <typename Row>
    void rows(Row& row) {
        row.number("bias", bias, 0.0F, 1e6F, "metres", "added to the automatic bias");
        row.number("constantBias", constantBias, 0.0F, 64.0F, "texels",
                   "automatic bias along the light, in footprints of a texel");
        row.number("slopeBias", slopeBias, 0.0F, 64.0F, "half texels",
                   "automatic bias along the receiver's slope");
    }
};

struct MultiViewSettings : MapSettings, BiasSettings {
    Pcf pcf = Pcf::five;

    template <typename Row>
    void rows(Row& row) {
        row.choice("pcf", pcf, {"1", "5", "9", "bilinear"},
                   "shadow tests per map: one texel, cross, 3x3, or four by distance");
        MapSettings::rows(row);
        BiasSettings::rows(row);
    }
};

}  // namespace penumbra::visibility
