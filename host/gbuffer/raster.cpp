// SPDX-License-Identifier: MIT
#include "host/gbuffer/raster.h"

#include <algorithm>

namespace penumbra::gbuffer {

constexpr std::uint64_t kFirstCapacity = 1 << 14;

TileList::TileList(runtime::Device& device)
    : device_(&device),
      tiles_(device, "raster tiles", std::min(kFirstCapacity, device.faults().firstCapacity)) {}

void TileList::clear() {
    if (used_ == counts_.size()) counts_.emplace_back(*device_, "tile count", 1);
    counts_[used_++].fill(0);
}

bool TileList::grew() {
    std::uint64_t wanted = 0;
    for (std::size_t i = 0; i < used_; ++i)
        wanted = std::max<std::uint64_t>(wanted, counts_[i].download()[0]);
    used_ = 0;
    if (wanted <= capacity()) return false;
    tiles_.grow(*device_, "raster tiles", wanted + wanted / 4);
    return true;
}

}  // namespace penumbra::gbuffer
