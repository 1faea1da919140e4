// SPDX-License-Identifier: MIT
// Renders and times one contender of a comparison, frame by frame.
#pragma once
#include <memory>

#include "host/pipeline.h"
#include "host/report/comparison.h"

namespace penumbra::report {

/// What metrics need of a frame.
struct SeenFrame {
    int number = 0, width = 0, height = 0;
    std::vector<std::uint8_t> picture;  ///< tone-mapped sRGB [height, width, 3]
    metrics::Plane visibility;          ///< mean over lights and channels; empty: the file has none
    std::vector<bool> mask;             ///< pixels that a light can reach
    std::vector<float> positions;       ///< [3, height, width], world; empty unless asked for
    double ms = 0, totalMs = 0;
};

class ContenderRun {
  public:
    /// `frames`: all that will be rendered. `positions`: keep what tells which receivers rest.
    ContenderRun(const Contender& contender, const std::vector<int>& frames, int repeats,
                 bool positions);
    ~ContenderRun();
    /// Renders a frame, writes its EXR file into `folder` unless that is empty.
    SeenFrame render(int number, const std::string& folder);
    /// Medians and counts of what was rendered.
    void finish(ContenderResult& result) const;
    std::vector<std::string> takeWarnings() { return pipeline_->takeWarnings(); }

  private:
    void time(const std::string& statsJson, SeenFrame& frame);
    Contender contender_;
    int repeats_;
    bool warm_ = false, single_;
    std::unique_ptr<Pipeline> pipeline_;
    std::map<std::string, std::vector<double>> stages_;
    std::vector<std::string> stageOrder_, files_;
    std::vector<double> ms_, totalMs_;
    std::uint64_t points_ = 0, mapTriangles_ = 0, mapBytes_ = 0, bytes_ = 0;
};

/// A name that is a file's: letters, digits, '.', '-', '_'.
std::string fileName(const std::string& label);

/// Frames of another renderer; `path` may hold #### for the number.
SeenFrame readFrame(const std::string& path, int number);

double median(std::vector<double> values);

}  // namespace penumbra::report
