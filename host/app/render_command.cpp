// SPDX-License-Identifier: MIT
// Renders a sequence: frame n is encoded and written on another thread while frame n + 1 renders.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <nlohmann/json.hpp>

#include "host/app/commands.h"
#include "host/app/frame_list.h"
#include "runtime/error.h"
#include "runtime/slow_notice.h"

namespace penumbra::app {
namespace {

std::atomic<int> interrupts{0};

/// The first SIGINT finishes the frame, the second stops at once.
void onInterrupt(int) {
    if (++interrupts > 1) _exit(static_cast<int>(ExitCode::interrupted));
}

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

void checkOutput(const RenderArguments& arguments) {
    const auto& path = arguments.output;
    requireUsage(endsWith(path, ".exr") || endsWith(path, ".png"),
                 "-o {} ends in neither .exr nor .png; choose one of them", path);
    requireUsage(arguments.options.aovs.empty() || endsWith(path, ".exr"),
                 "--aov needs an EXR file; -o {} is a PNG", path);
    const auto folder = std::filesystem::path(path).parent_path();
    if (folder.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    require(std::filesystem::is_directory(folder), "-o {}: the folder {} cannot be made: {}", path,
            folder.string(), error.message());
}

void writeFrame(const std::string& path, const Frame& frame) {
    if (endsWith(path, ".exr"))
        writeExr(path, frame);
    else
        writePng(path, frame);
}

/// Progress on stderr: a bar on a terminal, a plain line per frame elsewhere.
class Progress {
  public:
    Progress(std::size_t total, bool quiet)
        : total_(total), quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}

    void done(const std::string& path) {
        ++done_;
        if (quiet_) return;
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
        const double rate = static_cast<double>(done_) / std::max(elapsed.count(), 1e-9);
        const double left = static_cast<double>(total_ - done_) / rate;
        if (!terminal_) {
            fmt::print(stderr, "{} ({}/{}, {:.2f} frames/s)\n", path, done_, total_, rate);
            return;
        }
        const auto filled = 30 * done_ / total_;
        fmt::print(stderr, "\r[{}{}] {}/{} {:.2f} frames/s, {:.0f} s left {}",
                   std::string(filled, '#'), std::string(30 - filled, '.'), done_, total_, rate,
                   left, done_ == total_ ? "\n" : "");
    }
    void skipped(const std::string& path) {
        --total_;
        if (!quiet_ && !terminal_) fmt::print(stderr, "{} is whole: skipped\n", path);
    }

  private:
    std::size_t total_, done_ = 0;
    bool quiet_, terminal_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// True if the frame's files were written by these very options.
bool isWhole(const std::string& path, const std::string& fingerprint,
             const RenderOptions& options) {
    if (readFingerprint(path) != fingerprint) return false;
    const auto isWritten = [&](const char* aov, const std::string& file) {
        const auto& aovs = options.aovs;
        return std::find(aovs.begin(), aovs.end(), aov) == aovs.end() ||
               readFingerprint(file) == fingerprint;
    };
    return isWritten("depth-maps", depthMapsPath(path)) && isWritten("mask", masksPath(path));
}

void writeStats(const std::string& path, const Renderer& renderer, const nlohmann::json& frames) {
    auto json = nlohmann::json::parse(renderer.statsJson());
    json["frames"] = frames;
    std::ofstream file(path);
    file << json.dump(2) << '\n';
    require(static_cast<bool>(file.flush()), "--stats {}: cannot be written", path);
}

/// Median device time of each stage over the frames, as a table.
void printStages(const nlohmann::json& frames) {
    std::vector<std::string> names;
    std::map<std::string, std::vector<double>> times;
    std::vector<double> walls;
    for (const auto& frame : frames) {
        walls.push_back(frame["wallMs"]);
        for (const auto& stage : frame["stages"]) {
            const std::string name = stage["name"];
            if (!times.contains(name)) names.push_back(name);
            times[name].push_back(stage["deviceMs"]);
        }
    }
    const auto median = [](std::vector<double>& values) {
        std::nth_element(values.begin(),
                         values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                         values.end());
        return values[values.size() / 2];
    };
    fmt::print(stderr, "| stage | ms (median of {} frames) |\n|---|---|\n", frames.size());
    for (const auto& name : names)
        fmt::print(stderr, "| {} | {:.1f} |\n", name, median(times[name]));
    if (!walls.empty()) fmt::print(stderr, "| whole frame, wall | {:.1f} |\n", median(walls));
}

void printWarnings(Renderer& renderer, bool quiet) {
    for (const auto& warning : renderer.takeWarnings())
        if (!quiet) fmt::print(stderr, "penumbra: warning: {}\n", warning);
}

}  // namespace

int runRender(const RenderArguments& arguments) {
    checkOutput(arguments);
    if (!arguments.stats.empty())
        require(static_cast<bool>(std::ofstream(arguments.stats, std::ios::app)),
                "--stats {}: cannot be written", arguments.stats);
    if (arguments.quiet) runtime::SlowNotice::silence();
    RenderOptions options = arguments.options;
    options.profile = !arguments.stats.empty() || arguments.verbose;
    Renderer renderer(options);
    const auto frames = parseFrames(arguments.frames, renderer.frameCount());
    requireUsage(frames.size() == 1 || hasFrameNumber(arguments.output),
                 "--frames {} are {} frames and -o {} names one file; put #### into the name",
                 arguments.frames, frames.size(), arguments.output);
    printWarnings(renderer, arguments.quiet);
    if (arguments.verbose) fmt::print(stderr, "penumbra: device {}\n", renderer.deviceName());
    std::signal(SIGINT, onInterrupt);

    nlohmann::json stats = nlohmann::json::array();
    Progress progress(frames.size(), arguments.quiet);
    std::future<void> writing;
    for (const int number : frames) {
        if (interrupts > 0) break;
        const auto path = framePath(arguments.output, number);
        if (arguments.resume && isWhole(path, renderer.fingerprint(), options)) {
            progress.skipped(path);
            continue;
        }
        Frame frame = renderer.render(number);
        stats.push_back(nlohmann::json::parse(frame.statsJson));
        printWarnings(renderer, arguments.quiet);
        if (writing.valid()) writing.get();
        writing = std::async(std::launch::async, [path, &progress, frame = std::move(frame)] {
            writeFrame(path, frame);
            progress.done(path);
        });
    }
    if (writing.valid()) writing.get();
    if (!arguments.stats.empty()) writeStats(arguments.stats, renderer, stats);
    if (arguments.verbose && !stats.empty()) printStages(stats);
    if (interrupts > 0) {
        fmt::print(stderr,
                   "penumbra: interrupted; finished frames are whole, --resume renders the rest\n");
        return static_cast<int>(ExitCode::interrupted);
    }
    return 0;
}

}  // namespace penumbra::app
