// SPDX-License-Identifier: MIT
// Milliseconds per stage from the device's own events. Off: a stage costs one pointer assignment.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace cl {
class Event;
}

namespace penumbra::runtime {

class Device;

/// One stage of one frame: all launches between beginStage() calls of that name.
struct StageTime {
    std::string name;
    double deviceMs = 0;  ///< sum over launches, start to end
    double wallMs = 0;    ///< first start to last end on the device's clock
    int launches = 0;
    double maxLaunchMs = 0;
};

/// Start and end of a launch on the device's clock; both 0 where the driver keeps none.
struct Timestamps {
    std::uint64_t startNs = 0, endNs = 0;
};
using ReadTimestamps = std::function<Timestamps(const cl::Event&)>;

class Profiler {
  public:
    Profiler(Device& device, bool on);
    ~Profiler();
    bool on() const { return on_; }

    /// Takes timestamps from `read` instead of from the driver; whether they work is found out
    /// anew. Call it while nothing is measured. Tests feed what broken drivers give.
    void readTimestampsWith(ReadTimestamps read);

    /// Launches from here on belong to `name` (a literal or a string that outlives the frame).
    void beginStage(const char* name) { stage_ = name; }
    const char* stage() const { return stage_; }

    /// Event to hand to an enqueue call, or null when off.
    cl::Event* newEvent();
    /// Call after the enqueue when newEvent() gave one.
    void launched();

    /// Waits for the device, returns the stages since the last call in order of first launch.
    /// Drivers whose timestamps are zero are timed by the wall clock of the launches, which then
    /// run one by one; `timestampsWork()` tells.
    std::vector<StageTime> collect();
    bool timestampsWork() const { return timestampsWork_; }
    /// Forgets what was launched since the last collect(), without waiting.
    void discard();

  private:
    struct Launch;
    struct Span;
    Span spanOf(const Launch& launch) const;
    Device* device_;
    ReadTimestamps read_;
    bool on_;
    bool timestampsWork_ = true;
    bool timestampsChecked_ = false;
    const char* stage_ = "other";
    std::vector<std::unique_ptr<Launch>> launches_;
};

}  // namespace penumbra::runtime
