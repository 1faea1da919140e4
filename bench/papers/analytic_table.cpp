// SPDX-License-Identifier: MIT
// Every technique on scenes whose soft shadows are known on paper.
#include <cstdlib>

#include "bench/papers/papers.h"
#include "host/visibility/technique.h"
#include "tests/reference/analytic_scenes.h"
#include "tests/support/opened_device.h"

namespace penumbra::papers {
namespace {

using nlohmann::json;
using tests::AnalyticScene;

/// Of a disk raster4d needs a grid: about as many cells lie inside.
struct Samples {
    const char *count, *onDisk;
};
constexpr Samples kSamples[] = {{"64", "9x9"}, {"256", "18x18"}, {"1024", "36x36"}};

/// A row of the table: one technique on one scene, or on all angles of one.
json printErrors(const std::string& name, const std::vector<AnalyticScene>& scenes,
                 const std::string& technique, const std::vector<int>& widths) {
    std::vector<std::string> cells = {name, technique};
    json row = {{"scene", name}, {"technique", technique}};
    for (const auto& samples : kSamples) {
        const bool ownSamples = technique == "mvss";
        const auto error = tests::measureAnalytic(
            scenes, technique, scenes[0].disk && !ownSamples ? samples.onDisk : samples.count);
        for (const double value : {error.mean, error.largest})
            cells.push_back(fmt::format("{:.2f}", 255 * value));
        cells.push_back(fmt::format("{:+.2f}", 255 * error.bias));
        row[samples.count] = {{"mean", error.mean},
                              {"largest", error.largest},
                              {"bias", error.bias},
                              {"pixels", error.penumbra}};
    }
    printRow(cells, widths);
    return row;
}

}  // namespace

json analytic(const Request& request) {
    if (!request.device.empty()) setenv("PENUMBRA_DEVICE", request.device.c_str(), 1);
    fmt::print(
        "Visibility against closed forms, in 1/255, with 64, 256 and 1024 light samples: mean over "
        "the penumbra, largest anywhere, and mean with its sign (+: too bright). 64x48 pixels "
        "whatever --size says; hammersley samples, on the disk a grid (and its truth is one "
        "integral of exact chords); mvss has as many maps; pcss, essm and mlsm see the light's "
        "centre alone. {}\n",
        tests::device().info().name);
    const std::vector<int> widths{21, 9, 7, 7, 7};
    std::vector<std::string> head = {"scene", "technique"};
    for (const auto& samples : kSamples)
        for (const char* what : {samples.count, "largest", "signed"}) head.emplace_back(what);
    printRow(head, widths);
    const std::pair<const char*, std::vector<AnalyticScene>> suites[] = {
        {"half-plane, 24 angles", tests::halfPlanes()},
        {"sphere, disk light", {tests::sphereUnderDisk()}},
        {"box, rectangle", {tests::boxUnderRectangle()}},
        {"two half-planes", {tests::halfPlanesInSeries()}},
        {"six sheets", {tests::sheetsInSeries()}}};
    json rows = json::array();
    for (const auto& [name, scenes] : suites)
        for (const auto& entry : visibility::techniques())
            if (std::string(entry.name) != "none")
                rows.push_back(printErrors(name, scenes, entry.name, widths));
    return rows;
}

}  // namespace penumbra::papers
