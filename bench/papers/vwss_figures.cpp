// SPDX-License-Identifier: MIT
// Figures 8, 9, 10 and 13 of [VWSS].
#include <cmath>

#include "bench/papers/papers.h"
#include "runtime/error.h"

namespace penumbra::papers {
namespace {

using nlohmann::json;

json errorRows(const std::string& scene, const report::Comparison& comparison) {
    json rows = json::array();
    const std::vector<int> widths{11, 18, 11, 9, 9, 9, 9};
    for (const auto& r : comparison.results) {
        printRow({scene, r.contender.label, fmt::format("{:.2f}", r.ms),
                  fmt::format("{:.4f}", r.error.rmse), fmt::format("{:.4f}", r.error.flip),
                  fmt::format("{:.3f}", r.error.frameRmse255),
                  fmt::format("{:.4f}", r.error.frameFlip)},
                 widths);
        rows.push_back({{"scene", scene},
                        {"technique", r.contender.label},
                        {"ms", r.ms},
                        {"rmse", r.error.rmse},
                        {"flip", r.error.flip},
                        {"frameRmse255", r.error.frameRmse255},
                        {"frameFlip", r.error.frameFlip}});
    }
    return rows;
}

void printErrorHeader() {
    printRow({"scene", "technique", "shadows ms", "RMSE", "FLIP", "of 255", "FLIP"},
             {11, 18, 11, 9, 9, 9, 9});
}

void append(json& rows, const json& more) {
    for (const auto& row : more) rows.push_back(row);
}

/// The light of the scene volund, grown to `side` metres.
std::string volundLight(double side) {
    const double x = -0.55, y = 1.1, z = 0.5, distance = 5.669;
    const double scale = distance / std::sqrt(x * x + y * y + z * z);
    // The same power from a larger area
    return fmt::format("rect:at={:.6f},{:.6f},{:.6f};aim=0,1.4,0;size={}x{};radiance={:.4f};fov=60;near=2",
                       scale * x, 1.4 + scale * y, scale * z, side, side, 480 * 0.25 / (side * side));
}

}  // namespace

json vwssFigure8(const Request& request) {
    fmt::print("volund under a light that grows from 0.25 m to 2 m, samples with its area; errors against rays to 1024 "
               "samples\n");
    printErrorHeader();
    json rows = json::array();
    for (int area = 1; area <= 64; area *= 2) {
        auto base = baseOptions(request, 8 * area);
        const double side = 0.25 * std::sqrt(area);
        base.lights = {volundLight(side)};
        const auto name = fmt::format("volund-light-{}x", area);
        auto some = request;
        some.frames = 1;
        fmt::print("{} x the area: {:.3f} m, {} samples\n", area, side, 8 * area);
        append(rows, errorRows(name, compareOn("volund", name, {"vwss", "mvr"}, "raytrace:samples=1024",
                                               some, base)));
    }
    return rows;
}

json vwssFigure9(const Request& request) {
    fmt::print("Errors against mvr with 512 maps; FLIP stands where the paper has HDR-VDP-2\n");
    printErrorHeader();
    json rows = json::array();
    for (const char* scene : {"warriors", "cliffside"})
        append(rows, errorRows(scene, compareOn(scene, std::string(scene) + "-fig9", {"vwss", "pcss"},
                                                "mvr:samples=512", request, baseOptions(request, 24))));
    return rows;
}

json vwssFigure10(const Request& request) {
    fmt::print("Errors against mvr with 512 maps: thin parts and occluder fusion\n");
    printErrorHeader();
    return errorRows("challenger",
                     compareOn("challenger", "challenger-fig10", {"pcss", "vwss", "mvr"},
                               "mvr:samples=512", request, baseOptions(request, 24)));
}

json vwssFigure13(const Request& request) {
    const std::vector<int> widths{6, 14, 14, 14, 14, 14, 14};
    fmt::print("Milliseconds of points and depth maps on warriors, by number of maps\n");
    const std::vector<std::pair<std::string, std::string>> variants = {
        {"serial", "vwss:parallelism=serial"},
        {"partial (8)", "vwss:parallelism=partial:viewsPerPass=8"},
        {"full", "vwss:parallelism=full"},
        {"owned", "vwss:parallelism=owned"},
        {"unbuffered", "vwss:buffered=false"}};
    std::vector<std::string> header{"maps"};
    for (const auto& [name, text] : variants) header.push_back(name);
    printRow(header, widths);
    json rows = json::array();
    for (const int maps : {1, 8, 16, 32, 64, 128}) {
        std::vector<std::string> techniques, cells{std::to_string(maps)};
        for (const auto& [name, text] : variants) techniques.push_back(text);
        auto some = request;
        some.frames = 1;
        some.width = 320;
        some.height = 180;
        const auto comparison =
            compareOn("warriors", fmt::format("warriors-{}-maps", maps), techniques, "none", some,
                      baseOptions(some, maps));
        json row = {{"maps", maps}};
        for (std::size_t i = 0; i < variants.size(); ++i) {
            const double ms = stageMs(comparison.results[i], {"points", "depth maps"});
            cells.push_back(fmt::format("{:.2f}", ms));
            row[variants[i].first] = ms;
        }
        printRow(cells, widths);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace penumbra::papers
