// SPDX-License-Identifier: MIT
#include "host/report/contender_run.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "host/image/image_file.h"
#include "host/image/tone_map.h"
#include "kernels/shared/multi_view.h"
#include "runtime/error.h"

namespace penumbra::report {
namespace {

/// Stages that every technique shares: the camera's and shading. The rest is the technique's.
bool isShared(const std::string& stage) {
    static const char* const kShared[] = {"other",   "geometry", "raster",
                                          "resolve", "shading",  "temporal"};
    return std::find(std::begin(kShared), std::end(kShared), stage) != std::end(kShared);
}

/// Mean of the planes visibility.* of a frame or file.
metrics::Plane meanVisibility(const std::vector<Channel>& channels) {
    metrics::Plane mean;
    double count = 0;
    for (const auto& channel : channels) {
        if (channel.name.rfind("visibility.", 0) != 0) continue;
        if (mean.empty()) mean.assign(channel.values.size(), 0);
        for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += channel.values[i];
        ++count;
    }
    for (auto& value : mean) value /= static_cast<float>(count);
    return mean;
}

std::string numbered(const std::string& pattern, int frame) {
    const auto last = pattern.find_last_of('#');
    if (last == std::string::npos) return pattern;
    auto first = last;
    while (first > 0 && pattern[first - 1] == '#') --first;
    return fmt::format("{}{:0{}}{}", pattern.substr(0, first), frame, last - first + 1,
                       pattern.substr(last + 1));
}

}  // namespace

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::string fileName(const std::string& label) {
    std::string name = label;
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
    return name;
}

ContenderRun::ContenderRun(const Contender& contender, const std::vector<int>& frames, int repeats,
                           bool positions)
    : contender_(contender),
      repeats_(frames.size() == 1 ? repeats : 1),
      single_(frames.size() == 1) {
    auto options = contender.options;
    options.profile = true;
    options.aovs = {"visibility"};
    if (positions) options.aovs.emplace_back("position");
    pipeline_ = std::make_unique<Pipeline>(options);
    pipeline_->keepStates(true);
}

ContenderRun::~ContenderRun() = default;

void ContenderRun::time(const std::string& statsJson, SeenFrame& seen) {
    const auto stats = nlohmann::json::parse(statsJson);
    double ms = 0, total = 0;
    for (const auto& stage : stats.value("stages", nlohmann::json::array())) {
        const std::string name = stage["name"];
        const double device = stage["deviceMs"];
        if (!stages_.contains(name)) stageOrder_.push_back(name);
        stages_[name].push_back(device);
        total += device;
        if (!isShared(name)) ms += device;
    }
    ms_.push_back(ms);
    totalMs_.push_back(total);
    seen.ms = ms;
    seen.totalMs = total;
    points_ = std::max<std::uint64_t>(points_, stats["points"]);
    mapTriangles_ = std::max<std::uint64_t>(mapTriangles_, stats["mapTriangles"]);
    mapBytes_ = std::max<std::uint64_t>(mapBytes_, stats["mapBytes"]);
    bytes_ = std::max<std::uint64_t>(bytes_, stats["bytes"]);
}

SeenFrame ContenderRun::render(int number, const std::string& folder) {
    SeenFrame seen;
    // What is compiled at first use, and trees that are kept while nothing moves, are not timed
    if (!warm_) pipeline_->render(number);
    warm_ = true;
    for (int i = 1; i < repeats_; ++i) {
        if (pipeline_->frameCount() > 1) pipeline_->render(number + 1);
        time(pipeline_->render(number).statsJson, seen);
    }
    if (single_ && pipeline_->frameCount() > 1) pipeline_->render(number + 1);
    Frame frame = pipeline_->render(number);
    time(frame.statsJson, seen);
    seen.number = number;
    seen.width = frame.width;
    seen.height = frame.height;
    seen.picture = image::toneMap(frame);
    seen.visibility = meanVisibility(frame.channels);
    seen.mask = pipeline_->testedPixels();
    for (const auto& channel : frame.channels)
        if (channel.name.rfind("P.", 0) == 0)
            seen.positions.insert(seen.positions.end(), channel.values.begin(),
                                  channel.values.end());
    if (!folder.empty()) {
        const auto name = fmt::format("{}.{:04}.exr", fileName(contender_.label), number);
        writeExr((std::filesystem::path(folder) / name).string(), frame);
        files_.push_back(name);
    }
    return seen;
}

void ContenderRun::finish(ContenderResult& result) const {
    result.contender = contender_;
    result.stageOrder = stageOrder_;
    for (const auto& [name, times] : stages_) result.stageMs[name] = median(times);
    result.ms = median(ms_);
    result.totalMs = median(totalMs_);
    result.points = points_;
    result.mapTriangles = mapTriangles_;
    result.mapBytes = mapBytes_;
    result.bytes = bytes_;
    result.files = files_;
    const auto stats = nlohmann::json::parse(pipeline_->statsJson());
    for (const auto& [key, value] : stats["settings"].items())
        result.settings[key] = value.get<std::string>();
}

SeenFrame readFrame(const std::string& pattern, int number) {
    const std::string path = numbered(pattern, number);
    const auto image = image::readImage(path);
    const auto pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    Frame frame;
    frame.width = image.width;
    frame.height = image.height;
    frame.rgba.assign(4 * pixels, 1);
    const char* names[] = {"R", "G", "B", "A"};
    for (std::size_t c = 0; c < 4; ++c) {
        const auto* plane = image.find(names[c]);
        require(plane || c == 3, "{}: the reference has no channel {}", path, names[c]);
        for (std::size_t i = 0; plane && i < pixels; ++i) frame.rgba[4 * i + c] = (*plane)[i];
    }
    frame.exposure = static_cast<double>(metrics::commonGain(image, image));
    SeenFrame seen;
    seen.number = number;
    seen.width = image.width;
    seen.height = image.height;
    seen.picture = image::toneMap(frame);
    seen.visibility = meanVisibility(image.channels);
    return seen;
}

}  // namespace penumbra::report
