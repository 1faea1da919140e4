// SPDX-License-Identifier: MIT
#include "bench/support/bench.h"

#include <map>

#include "host/scene/animation.h"
#include "host/scene/builtin.h"

namespace penumbra::bench {

runtime::Device& device() {
    // Never destroyed: drivers may be gone already when static objects are
    static auto* const opened = [] {
        const auto devices = runtime::listDevices();
        runtime::DeviceOptions options;
        options.profiling = true;
        return new runtime::Device(devices.at(runtime::chooseDevice(devices, "").index), options);
    }();
    return *opened;
}

const runtime::Program& program(const std::string& name) {
    static auto& programs = *new std::map<std::string, std::unique_ptr<runtime::Program>>;
    auto& entry = programs[name];
    if (!entry) entry = std::make_unique<runtime::Program>(device(), name);
    return *entry;
}

namespace {

/// Device time of what `work` enqueues in one stage; empty: in all.
double stageMs(const std::string& name, const std::function<void()>& work) {
    device().profiler().collect();
    work();
    double sum = 0;
    for (const auto& stage : device().profiler().collect())
        if (name.empty() || stage.name == name) sum += stage.deviceMs;
    return sum;
}

}  // namespace

double deviceMs(const std::function<void()>& work) {
    return stageMs("", work);
}

void measure(benchmark::State& state, const std::function<void()>& work) {
    measureStage(state, "", work);
}

void measureStage(benchmark::State& state, const std::string& stage,
                  const std::function<void()>& work) {
    stageMs(stage, work);
    for (auto _ : state) state.SetIterationTime(1e-3 * stageMs(stage, work));
    state.SetLabel(device().info().name);
}

PosedScene& builtinScene() {
    static auto& posed = *[] {
        auto* p = new PosedScene;
        p->scene = scene::loadBuiltinScene();
        const auto clips = scene::chooseAnimations(p->scene, "");
        p->bounds = scene::clipBounds(p->scene, clips);
        p->geometry =
            std::make_unique<geometry::Geometry>(program("frame"), p->scene, p->bounds.centre());
        p->geometry->run(scene::poseAt(p->scene, clips, 0.25));
        return p;
    }();
    return posed;
}

scene::AreaLight lightWith(int samples) {
    auto& posed = builtinScene();
    scene::SampleChoice choice;
    choice.count = samples;
    const auto pose = scene::poseAt(posed.scene, scene::chooseAnimations(posed.scene, ""), 0.25);
    return scene::lightsAt(posed.scene, pose, posed.bounds, choice).at(0);
}

}  // namespace penumbra::bench
