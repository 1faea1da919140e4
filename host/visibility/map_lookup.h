// SPDX-License-Identifier: MIT
// Shadow tests of receivers against depth maps, the same few taps in each map.
#pragma once
#include "host/visibility/multi_view.h"

namespace penumbra::visibility {

struct LookupSettings {
    Pcf pcf = Pcf::five;
    BiasSettings bias;
    bool flat = false;  ///< taps compare with the receiver's depth, not with its plane's
};

/// Percentage-closer filtering with receiver-plane bias. Kernels: kernels/visibility/map_lookup.cl
class MapLookup : public MapReader {
  public:
    MapLookup(const runtime::Program& multiView, const LookupSettings& settings);
    int weight() const override;
    void read(const LightView& view, const MapBatch& batch, ReceiverImage& receivers) override;

  private:
    template <typename Texel>
    using Lookup =
        runtime::Kernel<shared::MultiViewParams, shared::LookupParams, int, Buffer<float>,
                        Buffer<float>, Buffer<Texel>, Buffer<std::uint32_t>>;
    runtime::Device* device_;
    LookupSettings settings_;
    Lookup<std::uint32_t> lookup32_;
    Lookup<std::uint16_t> lookup16_;
};

/// A reader's bias of the maps of one light.
void applyBias(const BiasSettings& bias, shared::LookupParams& params);

}  // namespace penumbra::visibility
