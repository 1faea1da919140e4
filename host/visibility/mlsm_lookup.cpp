// SPDX-License-Identifier: MIT
#include "host/visibility/mlsm_lookup.h"

#include <algorithm>
#include <cmath>

#include "host/visibility/map_lookup.h"

namespace penumbra::visibility {

MlsmReach mlsmReachOf(const LightView& view) {
    const double perMetre = static_cast<double>(view.params.focal) / view.params.near;
    const double rim = view.disk ? std::sqrt(3.14159265358979323846) / 2 : 1;
    const double width = 2 * rim * view.params.halfWidth, height = 2 * rim * view.params.halfHeight;
    const double longer = std::max(width, height), shorter = std::min(width, height);
    MlsmReach reach;
    if (!(longer > 0)) return reach;
    // A light that is next to a line is cut into squares all the same
    reach.parts =
        std::clamp(static_cast<int>(std::lround(longer / std::max(shorter, 1e-9 * longer))), 1,
                   MLSM_MAX_PARTS);
    const double part = longer / reach.parts, side = std::sqrt(part * std::max(shorter, part / 4));
    reach.size = side * perMetre;
    (width > height ? reach.stepX : reach.stepY) = part / side;
    return reach;
}

MlsmLookup::MlsmLookup(const runtime::Program& mlsm, const MlsmSettings& settings)
    : device_(&mlsm.device()),
      settings_(settings),
      lookup_(mlsm, "mlsm_lookup"),
      colour_(mlsm, "mlsm_lookup_colour") {}

void MlsmLookup::run(const LightView& view, const MlsmReach& reach, int accumulate,
                     const shared::MlsmParams& params, const MlsmMap& map,
                     ReceiverImage& receivers) {
    shared::LookupParams bias{};
    applyBias(settings_, bias);
    shared::MlsmLookupParams lookup{};
    lookup.reach = static_cast<float>(reach.size);
    lookup.stepX = static_cast<float>(reach.stepX);
    lookup.stepY = static_cast<float>(reach.stepY);
    lookup.parts = reach.parts;
    lookup.accumulate = accumulate;
    lookup.antialias = settings_.antialias ? receivers.onScreen : 0;
    lookup.receiverWidth = receivers.width;
    lookup.pixelStep = settings_.halfResolution ? 2 : 1;
    const runtime::Range items{
        static_cast<std::uint64_t>(receivers.stride / device_->info().lanes)};
    Lookup& kernel = params.channels == 1 ? lookup_ : colour_;
    kernel.launch(items, {64}, view.params, bias, params, lookup, receivers.stride,
                  receivers.planes, map.lists, map.fragments, receivers.hidden);
}

}  // namespace penumbra::visibility
