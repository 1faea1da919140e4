// SPDX-License-Identifier: MIT
// What the benchmarks share: the device, scenes by triangle count, device time of stages.
#pragma once
#include <benchmark/benchmark.h>

#include <functional>
#include <memory>
#include <string>

#include "host/geometry/geometry.h"
#include "host/scene/bounds.h"
#include "host/scene/light.h"
#include "runtime/device.h"
#include "runtime/profiler.h"
#include "runtime/program.h"

namespace penumbra::bench {

/// Opened once with profiling on; PENUMBRA_DEVICE chooses.
runtime::Device& device();
const runtime::Program& program(const std::string& name);

/// Milliseconds on the device of all that `work` enqueues.
double deviceMs(const std::function<void()>& work);

/// Runs `work` until the benchmark has enough: device time, device name as label. Runs it once
/// before.
void measure(benchmark::State& state, const std::function<void()>& work);

/// The same with the device time of the profiler's stage of that name alone.
void measureStage(benchmark::State& state, const std::string& stage,
                  const std::function<void()>& work);

/// The built-in scene, posed on the device.
struct PosedScene {
    scene::Scene scene;
    scene::Bounds bounds;
    std::unique_ptr<geometry::Geometry> geometry;
    scene::AreaLight light;  ///< the key light with `samples` samples
    const geometry::Mesh& mesh() const { return geometry->mesh(); }
};
PosedScene& builtinScene();
/// The key light of the scene with N hammersley samples.
scene::AreaLight lightWith(int samples);

}  // namespace penumbra::bench
