// SPDX-License-Identifier: MIT
// Measurements of a sequence while it renders: the file of --stats and the table of -v.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "runtime/whole_file.h"

namespace penumbra::app {

/// Of a frame nothing is kept in memory but its times, and these only for the table: sequences may
/// be long.
class FrameStats {
  public:
    /// `path`: of the JSON file; empty for none.
    FrameStats(const std::string& path, bool table);
    /// Adds a frame's JSON object.
    void add(const std::string& frameJson);
    /// Completes the file with the members of `rendererJson`, prints the table to stderr.
    void finish(const std::string& rendererJson);

  private:
    void write(const std::string& text);
    void addTimes(const std::string& frameJson);
    void printTable();

    std::unique_ptr<runtime::WholeFile> file_;
    bool table_;
    std::size_t frames_ = 0;
    std::vector<std::string> stageNames_;  ///< in the order of their first launch
    std::map<std::string, std::vector<double>> stageMs_;
    std::vector<double> wallMs_;
};

}  // namespace penumbra::app
