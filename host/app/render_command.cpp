// SPDX-License-Identifier: MIT
// Renders a sequence: frame n is encoded and written on another thread while frame n + 1 renders.
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <future>
#include <set>

#include "host/app/commands.h"
#include "host/app/frame_list.h"
#include "host/app/frame_stats.h"
#include "runtime/error.h"
#include "runtime/slow_notice.h"
#include "runtime/whole_file.h"

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

std::string folderOf(const std::string& path) {
    const auto folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

void checkOutput(const RenderArguments& arguments) {
    const auto& path = arguments.output;
    requireUsage(endsWith(path, ".exr") || endsWith(path, ".png"),
                 "-o {} ends in neither .exr nor .png; choose one of them", path);
    requireUsage(arguments.options.aovs.empty() || endsWith(path, ".exr"),
                 "--aov needs an EXR file; -o {} is a PNG", path);
    require(!std::filesystem::is_directory(path), "-o {} is a folder; name a file in it", path);
    const auto folder = folderOf(path);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    require(std::filesystem::is_directory(folder), "-o {}: the folder {} cannot be made: {}", path,
            folder, error.message());
    // Found out now, not after the first frame has been rendered
    const bool writable = access(folder.c_str(), W_OK | X_OK) == 0;
    require(writable, "-o {}: the folder {} cannot be written: {}", path, folder,
            std::strerror(errno));
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
        ++skipped_;
        if (!quiet_ && !terminal_) fmt::print(stderr, "{} is whole: skipped\n", path);
    }

    /// While nothing is being written.
    std::size_t wholeFrames() const { return done_ + skipped_; }

  private:
    std::size_t total_, done_ = 0, skipped_ = 0;
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

void printWarnings(Renderer& renderer, bool quiet) {
    for (const auto& warning : renderer.takeWarnings())
        if (!quiet) fmt::print(stderr, "penumbra: warning: {}\n", warning);
}

/// Names of the files of a sequence, without their folder.
std::set<std::string> fileNames(const RenderArguments& arguments, const std::vector<int>& frames) {
    std::set<std::string> names;
    for (const int number : frames) {
        const auto path = framePath(arguments.output, number);
        for (const auto& file : {path, depthMapsPath(path), masksPath(path)})
            names.insert(std::filesystem::path(file).filename().string());
    }
    return names;
}

/// Renders and writes; what is being written when an error occurs is still completed.
void renderFrames(const RenderArguments& arguments, const std::vector<int>& frames,
                  Renderer& renderer, FrameStats& stats, Progress& progress) {
    std::future<void> writing;
    for (const int number : frames) {
        if (interrupts > 0) break;
        const auto path = framePath(arguments.output, number);
        if (arguments.resume && isWhole(path, renderer.fingerprint(), arguments.options)) {
            progress.skipped(path);
            continue;
        }
        Frame frame = renderer.render(number);
        stats.add(frame.statsJson);
        printWarnings(renderer, arguments.quiet);
        if (writing.valid()) writing.get();
        writing = std::async(std::launch::async, [path, &progress, frame = std::move(frame)] {
            writeFrame(path, frame);
            progress.done(path);
        });
    }
    if (writing.valid()) writing.get();
}

}  // namespace

int runRender(const RenderArguments& arguments) {
    checkOutput(arguments);
    FrameStats stats(arguments.stats, arguments.verbose);
    if (arguments.quiet) runtime::SlowNotice::silence();
    RenderOptions options = arguments.options;
    options.profile = !arguments.stats.empty() || arguments.verbose;
    Renderer renderer(options);
    const auto frames = parseFrames(arguments.frames, renderer.frameCount());
    requireUsage(frames.size() == 1 || hasFrameNumber(arguments.output),
                 "--frames {} are {} frames and -o {} names one file; put #### into the name",
                 arguments.frames, frames.size(), arguments.output);
    runtime::removeAbandoned(folderOf(arguments.output), fileNames(arguments, frames));
    printWarnings(renderer, arguments.quiet);
    if (arguments.verbose) fmt::print(stderr, "penumbra: device {}\n", renderer.deviceName());
    std::signal(SIGINT, onInterrupt);

    Progress progress(frames.size(), arguments.quiet);
    try {
        renderFrames(arguments, frames, renderer, stats, progress);
    } catch (const Error& error) {
        if (frames.size() == 1) throw;
        throw Error(fmt::format("{}; {} of {} frames are whole, --resume renders the rest",
                                error.what(), progress.wholeFrames(), frames.size()),
                    error.code());
    }
    stats.finish(renderer.statsJson());
    if (interrupts > 0) {
        fmt::print(stderr,
                   "penumbra: interrupted; finished frames are whole, --resume renders the rest\n");
        return static_cast<int>(ExitCode::interrupted);
    }
    return 0;
}

}  // namespace penumbra::app
