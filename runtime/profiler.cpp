// SPDX-License-Identifier: MIT
#include "runtime/profiler.h"

#include <algorithm>
#include <chrono>

#include "runtime/device.h"
#include "runtime/opencl.h"

namespace penumbra::runtime {

using Clock = std::chrono::steady_clock;

struct Profiler::Launch {
    const char* stage = "";
    cl::Event event;
    Clock::time_point wallStart;
    double wallMs = 0;
};

namespace {

struct Span {
    double startMs = 0, endMs = 0;
};

Span spanOf(const cl::Event& event) {
    const auto start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    return {1e-6 * static_cast<double>(start), 1e-6 * static_cast<double>(end)};
}

}  // namespace

Profiler::Profiler(Device& device, bool on) : device_(&device), on_(on) {}
Profiler::~Profiler() = default;

cl::Event* Profiler::newEvent() {
    if (!on_) return nullptr;
    launches_.push_back(std::make_unique<Launch>());
    launches_.back()->stage = stage_;
    launches_.back()->wallStart = Clock::now();
    return &launches_.back()->event;
}

void Profiler::launched() {
    if (!on_) return;
    Launch& launch = *launches_.back();
    if (timestampsChecked_ && timestampsWork_) return;
    launch.event.wait();
    launch.wallMs =
        std::chrono::duration<double, std::milli>(Clock::now() - launch.wallStart).count();
    if (timestampsChecked_) return;
    timestampsChecked_ = true;
    timestampsWork_ = spanOf(launch.event).endMs > 0;
}

std::vector<StageTime> Profiler::collect() {
    device_->finish();
    std::vector<StageTime> stages;
    std::vector<Span> spans;
    for (const auto& launch : launches_) {
        const Span span = timestampsWork_ ? spanOf(launch->event) : Span{0, launch->wallMs};
        const auto found = std::find_if(stages.begin(), stages.end(),
                                        [&](const auto& s) { return s.name == launch->stage; });
        const auto index = static_cast<std::size_t>(found - stages.begin());
        if (found == stages.end()) {
            stages.push_back({launch->stage});
            spans.push_back(span);
        }
        StageTime& stage = stages[index];
        const double ms = span.endMs - span.startMs;
        stage.deviceMs += ms;
        stage.launches += 1;
        stage.maxLaunchMs = std::max(stage.maxLaunchMs, ms);
        spans[index].endMs = std::max(spans[index].endMs, span.endMs);
        stage.wallMs = timestampsWork_ ? spans[index].endMs - spans[index].startMs : stage.deviceMs;
    }
    launches_.clear();
    return stages;
}

}  // namespace penumbra::runtime
