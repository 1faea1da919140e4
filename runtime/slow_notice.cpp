// SPDX-License-Identifier: MIT
#include "runtime/slow_notice.h"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <cstdio>

namespace penumbra::runtime {
namespace {
std::atomic<bool> silent{false};
}

void SlowNotice::silence() {
    silent = true;
}

SlowNotice::SlowNotice(std::string what) : what_(std::move(what)) {
    thread_ = std::thread([this] {
        std::unique_lock lock(mutex_);
        if (!changed_.wait_for(lock, std::chrono::seconds(1), [this] { return done_; }) && !silent)
            fmt::print(stderr, "penumbra: {}\n", what_);
    });
}

SlowNotice::~SlowNotice() {
    {
        const std::lock_guard lock(mutex_);
        done_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

}  // namespace penumbra::runtime
