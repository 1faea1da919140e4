// SPDX-License-Identifier: MIT
// OpenCL devices: list, choose, explain, open.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/faults.h"

namespace cl {
class CommandQueue;
class Context;
class Device;
}  // namespace cl

namespace penumbra::runtime {

class Profiler;
class Program;

/// What a driver says of one device, and what penumbra makes of it.
struct DeviceInfo {
    int platformIndex = 0, deviceIndex = 0;
    std::string platform, name, vendor, driver, version;
    bool isCpu = false, isGpu = false, usable = true;
    std::string whyNot;  ///< why it is unusable, or never chosen unasked; else empty
    int computeUnits = 0;
    int clockMhz = 0;
    std::uint64_t globalBytes = 0, maxAllocBytes = 0, localBytes = 0;
    int maxWorkGroup = 0;
    bool atomics64 = false;     ///< 64-bit atomic max, by extension and quirk table
    int lanes = 1;              ///< floats per vector in kernels/lib/lanes.h: 1, 8 or 16
    bool cachesBuilds = false;  ///< the driver keeps compiled programs on disk itself
    bool chosenUnasked = true;  ///< false for emulators
};

/// All devices of all platforms that the ICD loader finds; platforms without devices add none.
std::vector<DeviceInfo> listDevices();

/// Where ICD files were looked for, for messages.
std::string icdSearchPath();

struct DeviceChoice {
    std::size_t index = 0;  ///< into the list
    std::string why;
};

/// Chooses by `request`: "cpu", "gpu", an index, "platform:device", or part of a name in any case;
/// empty: PENUMBRA_DEVICE, else the fastest GPU, else the fastest CPU, never an emulator.
/// Throws Error (exit code 3) saying what was found.
DeviceChoice chooseDevice(const std::vector<DeviceInfo>& devices, const std::string& request);

struct DeviceOptions {
    bool profiling = false;              ///< record events; see Profiler
    bool cache = true;                   ///< keep program binaries on disk
    std::uint64_t memoryLimitBytes = 0;  ///< 0: the device's own
    bool verbose = false;
};

/// How programs came to be, for --stats.
struct ProgramStats {
    int built = 0, loaded = 0;
    double ms = 0;
};

/// Current and largest sum of our buffers on the device.
struct MemoryUse {
    std::uint64_t current = 0, peak = 0;
};

/// An open device: context, one in-order queue, memory accounting. Not copyable; outlives all
/// buffers, programs and kernels made on it.
class Device {
  public:
    explicit Device(const DeviceInfo& info, const DeviceOptions& options = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    const DeviceInfo& info() const { return info_; }
    const DeviceOptions& options() const { return options_; }
    cl::Context& context() const;
    cl::CommandQueue& queue() const;
    cl::Device& handle() const;
    Profiler& profiler() const { return *profiler_; }

    /// Waits for all that was enqueued and releases staged uploads.
    void finish();
    /// Starts what was enqueued, without waiting.
    void flush();
    /// Keeps host memory of an upload alive until the next finish().
    void keepUntilFinish(std::shared_ptr<const void> data);

    /// Bytes that penumbra may use in all: the smaller of the device's memory and --memory.
    std::uint64_t memoryLimitBytes() const;
    const MemoryUse& memory() const { return memory_; }
    void accountMemory(std::int64_t bytes);
    ProgramStats& programs() { return programs_; }
    /// Programs made so far, by name and options: passes that share one build it once.
    std::map<std::string, std::shared_ptr<const Program>>& madePrograms() { return madePrograms_; }
    Faults& faults() { return faults_; }

    /// Remembers what the user should know, such as a cache that cannot be written.
    void warn(const std::string& warning);
    /// The warnings since the last call, each text once.
    std::vector<std::string> takeWarnings();

  private:
    struct Handles;
    DeviceInfo info_;
    DeviceOptions options_;
    std::unique_ptr<Handles> handles_;
    std::unique_ptr<Profiler> profiler_;
    std::vector<std::shared_ptr<const void>> staged_;
    MemoryUse memory_;
    ProgramStats programs_;
    std::map<std::string, std::shared_ptr<const Program>> madePrograms_;
    Faults faults_;
    std::vector<std::string> warnings_;
};

}  // namespace penumbra::runtime
