// SPDX-License-Identifier: MIT
#include "host/visibility/occupancy.h"

namespace penumbra::visibility {

Occupancy::Occupancy(const runtime::Program& multiView)
    : device_(&multiView.device()),
      mark_(multiView, "occupancy_mark"),
      sum_(multiView, "occupancy_sum"),
      skip_(multiView, "occupancy_skip"),
      cells_(*device_, "occupied cells", std::uint64_t{OCCUPANCY_ROW} * OCCUPANCY_ROW),
      range_(*device_, "range of casters", 1) {}

void Occupancy::skip(const Mesh& mesh, const LightView& view, int stride,
                     Buffer<float>& receivers) {
    cells_.fill(0);
    range_.fill({});
    mark_.launch({mesh.triangleCount}, {64}, view.params, mesh.triangleCount, mesh.positions,
                 mesh.indices, mesh.triangleDraw, mesh.draws, cells_, range_);
    sum_.launch({1}, {1}, cells_);
    skip_.launch({static_cast<std::uint64_t>(stride / device_->info().lanes)}, {64}, view.params,
                 stride, cells_, range_, receivers);
}

}  // namespace penumbra::visibility
