// SPDX-License-Identifier: MIT
// Twin of kernels/visibility/occupancy.cl in double: boxes around receivers against bounds of
// triangles, one by one, without a grid.
#pragma once
#include <vector>

#include "host/geometry/geometry.h"
#include "host/visibility/light_view.h"

namespace penumbra::tests {

/// yes: bounds of a caster meet the box in which something could hide a sample, or a sample lies
/// below the receiver's plane; no: none does within two cells of a grid either; near: between them.
enum class Shadowable { no, near, yes };

/// Per receiver of [RECEIVER_PLANES, stride].
std::vector<Shadowable> shadowableReceivers(const geometry::Mesh& mesh,
                                            const visibility::LightView& view,
                                            const std::vector<float>& receivers, int stride);

}  // namespace penumbra::tests
