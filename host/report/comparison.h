// SPDX-License-Identifier: MIT
// Techniques side by side on one scene: what each costs, and how far it is from a reference.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/metrics/picture.h"
#include "host/penumbra.h"

namespace penumbra::report {

/// An entry of --techniques: a technique and what differs from the options of the whole comparison.
struct Contender {
    std::string label;      ///< as the user wrote it: "vwss:pcf=1"; unique
    RenderOptions options;  ///< all of them, the technique's own included
};

/// Parses "vwss:pcf=1:temporal=4": settings of the technique by name, and `temporal`, `samples`,
/// `pattern`, `seed` of the render. Throws Error (usage).
Contender parseContender(const std::string& text, const RenderOptions& base);

/// Throws Error (usage) for settings and values that the technique does not have, before anything
/// renders. samplesOption: what the user calls the number of samples.
void checkContender(const Contender& contender, const std::string& samplesOption);

struct CompareOptions {
    RenderOptions base;
    std::vector<std::string> techniques;    ///< texts of contenders
    std::string reference = "raytrace";     ///< a contender, or an EXR file (#### is the frame)
    std::string referenceSamples = "1024";  ///< of a reference that is a technique
    std::vector<int> frames{0};
    bool sameSamples = true;  ///< also compare with rays to the very same samples
    int repeats = 3;          ///< timings of a single frame; medians are reported
    std::string sweep;        ///< "light-samples=8,16,32" or "resolution=256,512"
    std::string command;      ///< that makes the page again
    std::string folder;       ///< of the report
};

/// Distance of one frame from another.
struct FrameError {
    /// Of visibility over receivers that the light can reach; of the frame where one image has
    /// none.
    double rmse = 0, maximum = 0, mean = 0, share4 = 0, flip = 0;
    /// Of the tone-mapped frame: 8-bit levels, FLIP and SSIM.
    double frameRmse255 = 0, frameFlip = 0, frameSsim = 1;
};

struct FrameResult {
    int number = 0;
    FrameError reference;  ///< against the reference
    /// RMSE of visibility against rays to the very same light samples; none: not compared.
    std::optional<double> sameSamples;
    /// Mean change of visibility since the last frame on resting receivers; none: not known.
    std::optional<double> flicker;
    double ms = 0;       ///< of the technique: all stages but the camera's and shading
    double totalMs = 0;  ///< of all stages
};

/// What the page shows of one frame.
struct Pictures {
    int width = 0, height = 0;
    std::vector<std::uint8_t> frame;  ///< sRGB [height, width, 3]
    metrics::Plane visibility;        ///< mean over lights and channels
    std::vector<bool> mask;           ///< pixels that count
    metrics::Plane flip;              ///< of the tone-mapped frame
};

struct ContenderResult {
    Contender contender;
    std::map<std::string, double> stageMs;  ///< medians over frames
    std::vector<std::string> stageOrder;
    double ms = 0, totalMs = 0;           ///< medians
    std::optional<double> fasterThanMvr;  ///< ratio of `ms`; none without mvr in the list
    std::optional<double> sweepValue;
    bool ofVisibility = true;  ///< error.rmse ..: else of the picture, for want of it
    FrameError error;          ///< means over frames (maximum: largest)
    std::optional<double> sameSamples, flicker;  ///< means over the frames that have one
    std::uint64_t points = 0, mapTriangles = 0, mapBytes = 0, bytes = 0;
    std::vector<FrameResult> frames;
    std::vector<std::string> files;
    Pictures shown;  ///< of Comparison::shownFrame
    std::map<std::string, std::string> settings;
};

struct Comparison {
    CompareOptions options;
    std::string device, driver;
    int width = 0, height = 0;
    int shownFrame = 0;
    ContenderResult reference;
    std::vector<ContenderResult> results, sweep;
    std::vector<std::string> warnings;
};

/// Renders everything; EXR files go to options.folder. `progress` is called with a line of text
/// before each part. Throws Error for wrong options before anything is rendered.
Comparison compare(const CompareOptions& options, void (*progress)(const std::string& line));

/// Writes index.html and results.json into the comparison's folder.
void writeReport(const Comparison& comparison);

/// results.json; schema in the README.
std::string resultsJson(const Comparison& comparison);
/// index.html: self-contained.
std::string reportPage(const Comparison& comparison);

}  // namespace penumbra::report
