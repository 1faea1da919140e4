// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "host/metrics/image_error.h"
#include "host/report/comparison.h"
#include "host/report/contender_run.h"
#include "host/report/frame_error.h"
#include "runtime/error.h"

namespace penumbra::report {
namespace {

using Progress = void (*)(const std::string&);

/// Mean over the frames that have a value; none where no frame has.
std::optional<double> meanOf(const std::vector<FrameResult>& frames,
                             std::optional<double> FrameResult::*value) {
    double sum = 0, count = 0;
    for (const auto& frame : frames)
        if (frame.*value) sum += *(frame.*value), ++count;
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

/// Frames against which others are held, kept for the length of the comparison.
struct Truth {
    std::map<int, SeenFrame> frames;
    std::map<int, std::vector<bool>> resting;  ///< since the frame before
};

bool isFile(const std::string& reference) {
    return reference.size() > 4 && reference.substr(reference.size() - 4) == ".exr";
}

/// Of a reference that is a technique.
Contender referenceContender(const CompareOptions& options) {
    auto contender = parseContender(options.reference, options.base);
    const bool own = options.reference.find(":samples=") != std::string::npos;
    if (!own) contender.options.lightSamples = options.referenceSamples;
    checkContender(contender,
                   own ? fmt::format("'{}': samples", options.reference) : "--reference-samples");
    contender.label = "reference";
    return contender;
}

SeenFrame referenceFrame(const CompareOptions& options, int number) {
    auto frame = readFrame(options.reference, number);
    require(frame.width == options.base.width && frame.height == options.base.height,
            "the reference has {}x{} pixels, the frames {}x{}; use --size {}x{}", frame.width,
            frame.height, options.base.width, options.base.height, frame.width, frame.height);
    return frame;
}

ContenderResult runReference(const CompareOptions& options, Truth& truth, Comparison& comparison,
                             Progress progress) {
    ContenderResult result;
    if (isFile(options.reference)) {
        result.contender.label = options.reference;
        for (const int number : options.frames)
            truth.frames[number] = referenceFrame(options, number);
        return result;
    }
    const auto contender = referenceContender(options);
    ContenderRun run(contender, options.frames, 1, options.frames.size() > 1);
    const SeenFrame* last = nullptr;
    for (const int number : options.frames) {
        progress(fmt::format("reference {}, {} samples: frame {}", options.reference,
                             contender.options.lightSamples, number));
        auto& frame = truth.frames[number] = run.render(number, options.folder);
        FrameResult seen;
        seen.number = number;
        seen.ms = frame.ms;
        seen.totalMs = frame.totalMs;
        if (last) {
            truth.resting[number] = restingPixels(*last, frame);
            seen.flicker = flickerOf(*last, frame, truth.resting[number]);
        }
        result.frames.push_back(seen);
        last = &frame;
    }
    result.flicker = meanOf(result.frames, &FrameResult::flicker);
    run.finish(result);
    for (auto& warning : run.takeWarnings()) comparison.warnings.push_back(std::move(warning));
    return result;
}

/// Rays to the very samples of a contender: those of mvss are its own.
Contender raysTo(const Contender& contender, const RenderOptions& base) {
    Contender rays{"rays", base};
    rays.options.technique = "raytrace";
    rays.options.settings.clear();
    rays.options.temporal = contender.options.temporal;
    rays.options.lightSamples = contender.options.lightSamples;
    rays.options.lightPattern = contender.options.lightPattern;
    rays.options.seed = contender.options.seed;
    if (contender.options.technique == "mvss") {
        const auto setting = [&](const char* name, const char* fallback) {
            const auto found = contender.options.settings.find(name);
            return found == contender.options.settings.end() ? fallback : found->second;
        };
        rays.options.lightSamples = setting("mvss.maps", "28");
        rays.options.lightPattern = "poisson";
        rays.options.seed = setting("mvss.seed", "0");
    }
    return rays;
}

/// Visibility of rays to the same samples, rendered once for all contenders that share them.
class SameSamples {
  public:
    SameSamples(const CompareOptions& options, Progress progress)
        : options_(options), progress_(progress) {}
    const metrics::Plane& at(const Contender& contender, int number) {
        const Contender rays = raysTo(contender, options_.base);
        const auto& o = rays.options;
        const std::string key =
            fmt::format("{} {} {} {}", o.lightSamples, o.lightPattern, o.seed, o.temporal);
        auto& frames = known_[key];
        if (frames.empty()) {
            progress_(fmt::format("rays to {} {} samples", o.lightSamples, o.lightPattern));
            ContenderRun run(rays, options_.frames, 1, false);
            for (const int frame : options_.frames)
                frames[frame] = run.render(frame, "").visibility;
        }
        return frames[number];
    }

  private:
    const CompareOptions& options_;
    Progress progress_;
    std::map<std::string, std::map<int, metrics::Plane>> known_;
};

std::optional<double> visibilityRmse(const metrics::Plane& a, const SeenFrame& b,
                                     const std::vector<bool>& mask) {
    if (a.size() != b.visibility.size()) return std::nullopt;
    return metrics::imageError({&a}, {&b.visibility}, mask).rmse;
}

ContenderResult runContender(const Contender& contender, const Comparison& comparison,
                             const Truth& truth, SameSamples* rays, const std::string& folder,
                             Progress progress, std::vector<std::string>& warnings) {
    const auto& options = comparison.options;
    ContenderResult result;
    ContenderRun run(contender, options.frames, options.repeats, false);
    std::optional<SeenFrame> last;
    const auto count = static_cast<double>(options.frames.size());
    result.error.frameSsim = 0;
    for (const int number : options.frames) {
        progress(fmt::format("{}: frame {}", contender.label, number));
        SeenFrame frame = run.render(number, folder);
        const auto& reference = truth.frames.at(number);
        FrameResult seen;
        seen.number = number;
        seen.ms = frame.ms;
        seen.totalMs = frame.totalMs;
        const bool shown = number == comparison.shownFrame;
        const auto mask = pixelsThatCount(reference, frame);
        result.ofVisibility = reference.visibility.size() == frame.visibility.size();
        seen.reference = errorOf(reference, frame, mask, shown ? &result.shown.flip : nullptr);
        if (rays) seen.sameSamples = visibilityRmse(rays->at(contender, number), frame, mask);
        const auto resting = truth.resting.find(number);
        if (last && resting != truth.resting.end()) {
            seen.flicker = flickerOf(*last, frame, resting->second);
        }
        add(result.error, seen.reference);
        result.frames.push_back(seen);
        if (shown) {
            result.shown.width = frame.width;
            result.shown.height = frame.height;
            result.shown.frame = frame.picture;
            result.shown.visibility = frame.visibility;
            result.shown.mask = mask;
        }
        last = std::move(frame);
    }
    result.error = scaled(result.error, 1 / count);
    result.sameSamples = meanOf(result.frames, &FrameResult::sameSamples);
    result.flicker = meanOf(result.frames, &FrameResult::flicker);
    run.finish(result);
    for (auto& warning : run.takeWarnings()) warnings.push_back(std::move(warning));
    return result;
}

/// "light-samples=8,16" or "resolution=256,512": the key, and its values.
std::pair<std::string, std::vector<std::string>> parseSweep(const std::string& text) {
    const auto equals = text.find('=');
    requireUsage(equals != std::string::npos && equals > 0 && equals + 1 < text.size(),
                 "--sweep '{}' is not key=value,value,...; light-samples, or a setting that the "
                 "techniques have",
                 text);
    std::vector<std::string> values;
    for (std::size_t begin = equals + 1; begin <= text.size();) {
        const auto end = std::min(text.find(',', begin), text.size());
        values.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return {text.substr(0, equals), values};
}

double sweepNumber(const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    requireUsage(error == std::errc() && end == text.data() + text.size(),
                 "--sweep: '{}' is not a number", text);
    return value;
}

bool hasSetting(const std::string& technique, const std::string& key) {
    const auto rows = visibility::findTechnique(technique).describe();
    return std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row.name == key; });
}

bool canSweep(const std::string& technique, const std::string& key) {
    if (key != "light-samples") return hasSetting(technique, key);
    return technique != "pcss" && technique != "essm" &&
           technique != "none";  // one map or no light
}

/// A technique of --techniques at a value of the sweep.
Contender sweptContender(const CompareOptions& options, const std::string& text,
                         const std::string& key, const std::string& value) {
    const auto technique = parseContender(text, options.base).options.technique;
    // The samples of mvss are its own
    const std::string samples = technique == "mvss" ? "maps" : "samples";
    return parseContender(
        fmt::format("{}:{}={}", text, key == "light-samples" ? samples : key, value), options.base);
}

/// Checks a sweep before anything renders; names the contenders that it leaves out.
void checkSweep(const CompareOptions& options, std::vector<std::string>& warnings) {
    const auto [key, values] = parseSweep(options.sweep);
    for (const auto& value : values) sweepNumber(value);
    std::size_t swept = 0;
    for (const auto& text : options.techniques) {
        const auto technique = parseContender(text, options.base).options.technique;
        if (!canSweep(technique, key)) {
            warnings.push_back(
                fmt::format("--sweep {}: {} has none of it and is left out", key, text));
            continue;
        }
        ++swept;
        for (const auto& value : values)
            checkContender(sweptContender(options, text, key, value), "--sweep light-samples");
    }
    requireUsage(swept > 0,
                 "--sweep {}: no technique of --techniques has it; light-samples, or the name of a "
                 "setting (see penumbra techniques), without its technique",
                 key);
}

void runSweep(Comparison& comparison, const Truth& truth, Progress progress) {
    const auto& options = comparison.options;
    const auto [key, values] = parseSweep(options.sweep);
    for (const auto& value : values) {
        const double number = sweepNumber(value);
        for (const auto& text : options.techniques) {
            const auto technique = parseContender(text, options.base).options.technique;
            if (!canSweep(technique, key)) continue;
            const auto contender = sweptContender(options, text, key, value);
            auto result = runContender(contender, comparison, truth, nullptr, "", progress,
                                       comparison.warnings);
            result.contender.label = text;
            result.sweepValue = number;
            result.shown = {};
            comparison.sweep.push_back(std::move(result));
        }
    }
}

void compareTimes(Comparison& comparison) {
    const auto mvr =
        std::find_if(comparison.results.begin(), comparison.results.end(),
                     [](const auto& r) { return r.contender.options.technique == "mvr"; });
    if (mvr == comparison.results.end()) return;
    for (auto& result : comparison.results)
        if (result.ms > 0) result.fasterThanMvr = mvr->ms / result.ms;
}

}  // namespace

Comparison compare(const CompareOptions& options, Progress progress) {
    requireUsage(!options.techniques.empty(), "--techniques names none; see penumbra techniques");
    requireUsage(!options.frames.empty(), "--frames names none");
    requireUsage(options.repeats >= 1 && options.repeats <= 100,
                 "--repeats {} is outside of 1 to 100", options.repeats);
    std::vector<Contender> contenders;
    std::set<std::string> labels{"reference"};
    for (const auto& text : options.techniques) {
        contenders.push_back(parseContender(text, options.base));
        checkContender(contenders.back(), text.find(":samples=") == std::string::npos
                                              ? "--light-samples"
                                              : fmt::format("'{}': samples", text));
        requireUsage(labels.insert(fileName(text)).second, "technique '{}' is listed twice", text);
    }
    Comparison comparison;
    if (!options.sweep.empty()) checkSweep(options, comparison.warnings);
    if (isFile(options.reference))
        requireUsage(
            options.frames.size() == 1 || options.reference.find('#') != std::string::npos,
            "--frames are {} frames and --reference {} is one file; put #### into the name",
            options.frames.size(), options.reference);
    else
        referenceContender(options);
    std::error_code error;
    std::filesystem::create_directories(options.folder, error);
    require(std::filesystem::is_directory(options.folder),
            "--report {}: the folder cannot be made: {}", options.folder, error.message());

    comparison.options = options;
    comparison.shownFrame = options.frames[options.frames.size() / 2];
    Truth truth;
    comparison.reference = runReference(options, truth, comparison, progress);
    SameSamples rays(options, progress);
    for (const auto& contender : contenders)
        comparison.results.push_back(runContender(contender, comparison, truth,
                                                  options.sameSamples ? &rays : nullptr,
                                                  options.folder, progress, comparison.warnings));
    if (!options.sweep.empty()) runSweep(comparison, truth, progress);
    const auto& shown = truth.frames.at(comparison.shownFrame);
    comparison.width = shown.width;
    comparison.height = shown.height;
    comparison.reference.shown = {shown.width,      shown.height, shown.picture,
                                  shown.visibility, shown.mask,   {}};
    compareTimes(comparison);
    // A reference from a file has no device
    comparison.device = comparison.results.front().settings.at("device");
    comparison.driver = comparison.results.front().settings.at("driver");
    std::sort(comparison.warnings.begin(), comparison.warnings.end());
    comparison.warnings.erase(std::unique(comparison.warnings.begin(), comparison.warnings.end()),
                              comparison.warnings.end());
    return comparison;
}

}  // namespace penumbra::report
