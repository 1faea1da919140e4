// SPDX-License-Identifier: MIT
#include "runtime/memory_plan.h"

#include <algorithm>

#include "runtime/error.h"

namespace penumbra::runtime {
namespace {
double megabytes(std::uint64_t bytes) {
    return static_cast<double>(bytes) / (1024.0 * 1024.0);
}
}  // namespace

void MemoryPlan::add(const std::string& label, std::uint64_t bytes) {
    entries_.push_back({label, bytes, true});
}

void MemoryPlan::addHeld(const std::string& label) {
    entries_.push_back({label, device_->memory().current, false});
}

std::uint64_t MemoryPlan::plannedBytes() const {
    std::uint64_t sum = 0;
    for (const auto& entry : entries_) sum += entry.bytes;
    return sum;
}

std::uint64_t MemoryPlan::freeBytes() const {
    const auto usable = device_->memoryLimitBytes() / 10 * 9;
    const auto planned = plannedBytes();
    return usable > planned ? usable - planned : 0;
}

void MemoryPlan::check() const {
    auto sorted = entries_;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Entry& a, const Entry& b) { return a.bytes > b.bytes; });
    std::string largest;
    for (std::size_t i = 0; i < std::min<std::size_t>(sorted.size(), 4); ++i)
        largest += fmt::format("{}{} {:.1f} MB", i ? ", " : "", sorted[i].label,
                               megabytes(sorted[i].bytes));
    const auto limit = device_->memoryLimitBytes();
    const auto maxAlloc = device_->info().maxAllocBytes;
    std::erase_if(sorted, [](const Entry& e) { return !e.oneBuffer; });
    if (!sorted.empty() && sorted[0].bytes > maxAlloc)
        throw Error(
            fmt::format("out of memory: {} needs {:.1f} MB at once, {} allows {:.1f} MB; use a "
                        "smaller --size or resolution",
                        sorted[0].label, megabytes(sorted[0].bytes), device_->info().name,
                        megabytes(maxAlloc)),
            ExitCode::outOfMemory);
    if (plannedBytes() > limit)
        throw Error(
            fmt::format("out of memory: the plan needs {:.1f} MB ({}), {} may use {:.1f} MB; "
                        "use a smaller --size, resolution or fewer light samples, or raise "
                        "--memory",
                        megabytes(plannedBytes()), largest, device_->info().name, megabytes(limit)),
            ExitCode::outOfMemory);
}

}  // namespace penumbra::runtime
