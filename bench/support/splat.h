// SPDX-License-Identifier: MIT
// Points of the built-in scene on the device, for the benchmarks of what makes and uses them.
#pragma once
#include "bench/support/bench.h"
#include "host/visibility/points.h"

namespace penumbra::bench {

/// Points of the built-in scene for maps of 1024^2, with room for `views` maps.
struct Splat {
    explicit Splat(int views, const runtime::Program& used = program("multi_view"),
                   visibility::Precision precision = visibility::Precision::single);
    /// Enqueues making the points anew.
    void generate();

    scene::AreaLight light;
    visibility::LightView view;
    visibility::Points points;
    runtime::Buffer<float> samples;
    runtime::Buffer<shared::MultiViewCounters> counters;
    runtime::Buffer<std::uint32_t> maps;
    std::int64_t count = 0;
};

}  // namespace penumbra::bench
