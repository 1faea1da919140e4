// SPDX-License-Identifier: MIT
// The papers' tables and figures, measured here and printed beside the papers' own numbers, and
// what is known on paper.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "host/report/comparison.h"
#include "runtime/device.h"

namespace penumbra::papers {

struct Request {
    std::string report;  ///< folder for pages of each scene; empty: none are kept
    int frames = 4;      ///< of the animation, evenly spaced
    int width = 1280, height = 720;
    std::string device;
};

/// A table: prints itself to stdout and gives its rows as JSON.
struct Table {
    const char* name;
    const char* what;
    nlohmann::json (*run)(const Request& request);
};
const std::vector<Table>& tables();

/// Makes one of tools/make_scene's scenes in a temporary folder; the path of the file. Made once.
std::string sceneFile(const std::string& name);

/// A comparison on a scene; the page goes to request.report/<name>.
report::Comparison compareOn(const std::string& scene, const std::string& name,
                             const std::vector<std::string>& techniques,
                             const std::string& reference, const Request& request,
                             const RenderOptions& base);

/// Options of the study: Poisson samples, the request's size and device.
RenderOptions baseOptions(const Request& request, int samples);

/// Device milliseconds of the named stages of a result together.
double stageMs(const report::ContenderResult& result, const std::vector<std::string>& stages);
/// Standard deviation of the frames' total times, ms.
double deviation(const report::ContenderResult& result);

/// One line of cells, each padded to its column.
void printRow(const std::vector<std::string>& cells, const std::vector<int>& widths);

/// The device of the request, opened once.
runtime::Device& openDevice(const Request& request);

nlohmann::json goals(const Request& request);
nlohmann::json analytic(const Request& request);
nlohmann::json vwssTable1(const Request& request);
nlohmann::json vwssTable2(const Request& request);
nlohmann::json vwssFigure8(const Request& request);
nlohmann::json vwssFigure9(const Request& request);
nlohmann::json vwssFigure10(const Request& request);
nlohmann::json vwssFigure13(const Request& request);
nlohmann::json mvssTable1(const Request& request);
#ifdef PENUMBRA_EMBREE
std::vector<std::string> fourdScenes();
nlohmann::json fourdTable1(const Request& request);
nlohmann::json fourdTable2(const Request& request);
nlohmann::json fourdTable3(const Request& request);
nlohmann::json fourdTable4(const Request& request);
nlohmann::json fourdTable5(const Request& request);
nlohmann::json fourdTable6(const Request& request);
nlohmann::json fourdTable8(const Request& request);
nlohmann::json fourdExactness(const Request& request);
#endif
nlohmann::json mlsmTable1(const Request& request);
nlohmann::json mlsmTable2(const Request& request);
nlohmann::json mlsmTable3(const Request& request);
nlohmann::json mlsmTable4(const Request& request);

}  // namespace penumbra::papers
