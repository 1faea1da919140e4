// SPDX-License-Identifier: MIT
// Every technique on scenes whose soft shadows are known on paper.
#include <cmath>

#include "bench/papers/papers.h"
#include "host/pipeline.h"
#include "runtime/error.h"
#include "tests/reference/analytic_scenes.h"

namespace penumbra::papers {
namespace {

using nlohmann::json;
using tests::AnalyticError;
using tests::AnalyticScene;

/// Light samples: N of a pattern, and on disks a grid of about as many, which raster4d needs there.
struct Samples {
    const char *count, *onDisk;
};
constexpr Samples kSamples[] = {{"64", "9x9"}, {"256", "18x18"}, {"1024", "36x36"}};
constexpr int kWidth = 64, kHeight = 48;

const std::vector<float>& planeOf(const Frame& frame, const std::string& name) {
    for (const auto& channel : frame.channels)
        if (channel.name == name) return channel.values;
    throw Error("the frame has no channel " + name, ExitCode::failed);
}

void addErrors(const AnalyticScene& scene, const std::string& technique, const Samples& samples,
               const std::string& device, AnalyticError& error) {
    RenderOptions options;
    options.technique = technique;
    options.width = kWidth;
    options.height = kHeight;
    options.eye = {{scene.eye.x, scene.eye.y, scene.eye.z}};
    options.target = {{scene.target.x, scene.target.y, scene.target.z}};
    options.lightSamples = scene.disk ? samples.onDisk : samples.count;
    options.aovs = {"visibility", "position"};
    options.device = device;
    if (technique == "mvss") options.settings["mvss.maps"] = samples.count;
    auto lit = scene.scene;
    lit.lights = {scene::parseLight(scene.light)};
    const Frame frame = Pipeline(options, lit).render(0);
    const auto &x = planeOf(frame, "P.X"), &y = planeOf(frame, "P.Y"), &z = planeOf(frame, "P.Z");
    const auto& seen = planeOf(frame, "visibility.key.R");
    for (std::size_t i = 0; i < seen.size(); ++i)
        if (std::abs(y[i]) < 1e-3F && std::abs(x[i]) <= 1)
            error.add(scene.truth({x[i], y[i], z[i]}), seen[i]);
}

/// A row of the table: one technique on one scene, or on all angles of one.
json printErrors(const std::string& name, const std::vector<AnalyticScene>& scenes,
                 const std::string& technique, const Request& request,
                 const std::vector<int>& widths) {
    std::vector<std::string> cells = {name, technique};
    json row = {{"scene", name}, {"technique", technique}};
    for (const auto& samples : kSamples) {
        AnalyticError error;
        for (const auto& scene : scenes)
            addErrors(scene, technique, samples, request.device, error);
        error.finish();
        cells.push_back(fmt::format("{:.2f}", 255 * error.mean));
        cells.push_back(fmt::format("{:.1f}", 255 * error.largest));
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
    fmt::print(
        "Visibility against closed forms, in 1/255: mean over the penumbra, largest anywhere, mean "
        "with its sign (+ is too bright). {}x{} pixels, hammersley samples (on the disk a grid, "
        "the truth one integral of exact chords); mvss with as many maps; pcss, essm and mlsm look "
        "from the centre alone\n",
        kWidth, kHeight);
    const std::vector<int> widths{22, 9, 7, 7, 7};
    std::vector<std::string> head = {"scene", "technique"};
    for (const auto& samples : kSamples)
        for (const char* what : {"mean", "largest", "sign"})
            head.push_back(*what == 'm' ? fmt::format("{}:", samples.count) + " mean" : what);
    printRow(head, widths);
    json rows = json::array();
    const std::pair<const char*, std::vector<AnalyticScene>> suites[] = {
        {"half-plane, 24 angles", tests::halfPlanes()},
        {"sphere, disk light", {tests::sphereUnderDisk()}},
        {"box, rectangle", {tests::boxUnderRectangle()}},
        {"two half-planes", {tests::halfPlanesInSeries()}},
        {"six sheets", {tests::sheetsInSeries()}}};
    for (const auto& [name, scenes] : suites)
        for (const auto& entry : visibility::techniques())
            if (std::string(entry.name) != "none")
                rows.push_back(printErrors(name, scenes, entry.name, request, widths));
    return rows;
}

}  // namespace penumbra::papers
