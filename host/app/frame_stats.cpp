// SPDX-License-Identifier: MIT
#include "host/app/frame_stats.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runtime/error.h"

namespace penumbra::app {
namespace {

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace

FrameStats::FrameStats(const std::string& path, bool table) : table_(table) {
    if (path.empty()) return;
    try {
        file_ = std::make_unique<runtime::WholeFile>(path);
    } catch (const Error& error) {
        throw Error(fmt::format("--stats {}", error.what()));
    }
    write("{\"frames\": [");
}

void FrameStats::write(const std::string& text) {
    if (file_) file_->write(text.data(), text.size());
}

void FrameStats::add(const std::string& frameJson) {
    write((frames_++ ? ",\n" : "\n") + frameJson);
    if (table_) addTimes(frameJson);
}

void FrameStats::addTimes(const std::string& frameJson) {
    const auto frame = nlohmann::json::parse(frameJson);
    wallMs_.push_back(frame["wallMs"]);
    for (const auto& stage : frame["stages"]) {
        const std::string name = stage["name"];
        if (!stageMs_.contains(name)) stageNames_.push_back(name);
        stageMs_[name].push_back(stage["deviceMs"]);
    }
}

void FrameStats::finish(const std::string& rendererJson) {
    write("],\n" + rendererJson.substr(1) + "\n");
    if (file_) file_->commit();
    if (table_ && frames_ > 0) printTable();
}

/// Median device time of each stage over the frames.
void FrameStats::printTable() {
    fmt::print(stderr, "| stage | ms (median of {} frames) |\n|---|---|\n", frames_);
    for (const auto& name : stageNames_)
        fmt::print(stderr, "| {} | {:.1f} |\n", name, median(stageMs_[name]));
    fmt::print(stderr, "| whole frame, wall | {:.1f} |\n", median(wallMs_));
}

}  // namespace penumbra::app
