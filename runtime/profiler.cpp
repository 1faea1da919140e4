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

struct Profiler::Span {
    double startMs = 0, endMs = 0;
};

namespace {

Timestamps driverTimestamps(const cl::Event& event) {
    try {
        return {event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
                event.getProfilingInfo<CL_PROFILING_COMMAND_END>()};
    } catch (const cl::Error&) {
        return {};  // not kept for this launch: as good as zero
    }
}

}  // namespace

Profiler::Profiler(Device& device, bool on) : device_(&device), read_(driverTimestamps), on_(on) {}
Profiler::~Profiler() = default;

void Profiler::readTimestampsWith(ReadTimestamps read) {
    read_ = std::move(read);
    timestampsWork_ = true;
    timestampsChecked_ = false;
}

Profiler::Span Profiler::spanOf(const Launch& launch) const {
    if (!timestampsWork_) return {0, launch.wallMs};
    const Timestamps t = read_(launch.event);
    return {1e-6 * static_cast<double>(t.startNs), 1e-6 * static_cast<double>(t.endNs)};
}

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
    timestampsWork_ = read_(launch.event).endNs > 0;
}

void Profiler::discard() {
    launches_.clear();
}

std::vector<StageTime> Profiler::collect() {
    device_->finish();
    std::vector<StageTime> stages;
    std::vector<Span> spans;
    for (const auto& launch : launches_) {
        const Span span = spanOf(*launch);
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
