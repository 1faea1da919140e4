// SPDX-License-Identifier: MIT
#include "bench/support/splat.h"

namespace penumbra::bench {

Splat::Splat(int views, const runtime::Program& used, visibility::Precision precision)
    : light(lightWith(views)),
      view(visibility::fitLightView(light, builtinScene().bounds, builtinScene().bounds.centre(),
                                    1024, 1)),
      points(used, visibility::Cull::automatic, precision),
      samples(device(), "samples", view.samples),
      counters(device(), "counters", 1),
      maps(device(), "maps",
           static_cast<std::uint64_t>(view.params.mapStride) * static_cast<std::uint64_t>(views)) {
    view.params.depthBits = 32;
    points.grow(1 << 20);
    do generate();
    while (points.grewTiles());
    count = counters.download()[0].points;
}

void Splat::generate() {
    points.adapt(builtinScene().mesh(), view);
    counters.fill({});
    points.run(builtinScene().mesh(), view, counters);
}

}  // namespace penumbra::bench
