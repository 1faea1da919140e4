// SPDX-License-Identifier: MIT
#include "runtime/crash_notice.h"

#include <unistd.h>

#include <csignal>
#include <string>

#include "runtime/driver_cache.h"
#include "runtime/error.h"

namespace penumbra::runtime {
namespace {

/// Made beforehand: a signal handler may not allocate.
std::string& notice() {
    static std::string text;
    return text;
}

void onCrash(int) {
    const auto& text = notice();
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text.data(), text.size());
    _exit(static_cast<int>(ExitCode::failed));
}

}  // namespace

void announceCrashes() {
    const auto cache = driverCacheFolder();
    notice() = fmt::format(
        "penumbra: the OpenCL driver stopped the program; finished frames are whole, and --resume "
        "renders the rest{}\n",
        cache.empty() ? "" : "; if it does so again, its cache may be damaged: remove " + cache);
    std::signal(SIGXFSZ, SIG_IGN);
    keepAnnouncingCrashes();
}

void keepAnnouncingCrashes() {
    if (notice().empty()) return;
    std::signal(SIGABRT, onCrash);
    std::signal(SIGBUS, onCrash);
}

}  // namespace penumbra::runtime
