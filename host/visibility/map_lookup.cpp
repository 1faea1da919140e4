// SPDX-License-Identifier: MIT
#include "host/visibility/map_lookup.h"

namespace penumbra::visibility {

MapLookup::MapLookup(const runtime::Program& multiView, const LookupSettings& settings)
    : device_(&multiView.device()),
      settings_(settings),
      lookup32_(multiView, "map_lookup"),
      lookup16_(multiView, "map_lookup16") {}

int MapLookup::weight() const {
    switch (settings_.pcf) {
        case Pcf::one:
            return 1;
        case Pcf::five:
            return 5;
        case Pcf::nine:
            return 9;
        default:
            return 256;
    }
}

void applyBias(const BiasSettings& bias, shared::LookupParams& params) {
    params.slopeBias = bias.slopeBias;
    params.constantTexels = bias.constantBias;
    params.constantMetres = bias.bias;
}

void MapLookup::read(const LightView& view, const MapBatch& batch, ReceiverImage& receivers) {
    shared::LookupParams params{};
    params.firstView = params.mapView = batch.firstView;
    params.viewCount = batch.viewCount;
    params.pcf = settings_.pcf == Pcf::bilinear ? 4 : weight();
    params.flat = settings_.flat ? 1 : 0;
    applyBias(settings_.bias, params);
    params.quantum = batch.maps16 ? 1.0F / 65535 : 0;
    const runtime::Range items{
        static_cast<std::uint64_t>(receivers.stride / device_->info().lanes)};
    if (batch.maps16)
        lookup16_.launch(items, {64}, view.params, params, receivers.stride, receivers.planes,
                         *receivers.samples, *batch.maps16, receivers.hidden);
    else
        lookup32_.launch(items, {64}, view.params, params, receivers.stride, receivers.planes,
                         *receivers.samples, *batch.maps32, receivers.hidden);
}

}  // namespace penumbra::visibility
