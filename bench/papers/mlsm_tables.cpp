// SPDX-License-Identifier: MIT
// Tables 1 to 4 of [MLSM] on stand-ins of its scenes: hall for Sponza, street for Streets of Asia,
// foliage for its tree.
#include <algorithm>

#include "bench/papers/papers.h"
#include "runtime/error.h"
#ifdef PENUMBRA_EMBREE
#include "bench/papers/embree_frame.h"
#endif

namespace penumbra::papers {
namespace {

using nlohmann::json;

struct Column {
    const char* name;
    const char* technique;
};
constexpr const char* kAll = "mlsm:epsilon=10:maxLevel=4:halfResolution=true";
constexpr Column kColumns[] = {{"default", "mlsm"},
                               {"epsilon=10", "mlsm:epsilon=10"},
                               {"5 levels", "mlsm:maxLevel=4"},
                               {"half", "mlsm:halfResolution=true"},
                               {"all", kAll}};

struct Row {
    const char* name;
    std::vector<std::string> stages;
    std::vector<double> paper;  ///< GeForce Titan
};

std::vector<std::string> techniquesOf(const std::vector<Column>& columns) {
    std::vector<std::string> techniques;
    for (const auto& column : columns) techniques.emplace_back(column.technique);
    return techniques;
}

/// Stages by settings; one column of ours and one of the paper's per setting.
json stageTable(const char* scene, const std::vector<Row>& rows, const Request& request) {
    const std::vector<Column> columns(std::begin(kColumns), std::end(kColumns));
    const auto comparison = compareOn(scene, std::string(scene) + "-stages", techniquesOf(columns),
                                      "none", request, baseOptions(request, 128));
    const std::vector<int> widths{16, 12, 12, 12, 12, 12};
    fmt::print(
        "Milliseconds of {}, 1024^2 texels; in brackets the paper's, of a GeForce Titan at "
        "1280x720\n",
        scene);
    std::vector<std::string> header{"stage"};
    for (const auto& column : columns) header.emplace_back(column.name);
    printRow(header, widths);
    json result = json::array();
    for (const auto& row : rows) {
        std::vector<std::string> cells{row.name};
        json entry = {{"scene", scene}, {"stage", row.name}};
        for (std::size_t i = 0; i < columns.size(); ++i) {
            const auto& r = comparison.results[i];
            double value = row.stages.empty() ? 1000 / r.totalMs : stageMs(r, row.stages);
            cells.push_back(fmt::format("{:.1f} ({:.2f})", value, row.paper[i]));
            entry[columns[i].name] = value;
            entry["paper"].push_back(row.paper[i]);
        }
        printRow(cells, widths);
        result.push_back(entry);
    }
    return result;
}

std::vector<Row> stageRows(const std::vector<std::vector<double>>& paper) {
    return {{"scene", {"geometry", "raster", "resolve", "shading"}, paper[0]},
            {"counting", {"fragment counting"}, paper[1]},
            {"scan", {"fragment scan"}, paper[2]},
            {"collecting", {"fragment collecting"}, paper[3]},
            {"sorting", {"fragment sorting"}, paper[4]},
            {"filtering", {"filtering"}, paper[5]},
            {"lookup", {"lighting", "rays", "tree"}, paper[6]},
            {"frames/s", {}, paper[7]}};
}

/// Milliseconds of the technique alone.
double shadowMs(const report::ContenderResult& r) {
    return r.ms;
}

}  // namespace

json mlsmTable1(const Request& request) {
    return stageTable("hall",
                      stageRows({{1.46, 1.46, 1.46, 1.46, 1.46},
                                 {0.83, 0.83, 0.83, 0.83, 0.83},
                                 {0.27, 0.27, 0.27, 0.27, 0.27},
                                 {1.29, 1.29, 1.29, 1.29, 1.29},
                                 {0.63, 0.63, 0.63, 0.63, 0.63},
                                 {3.35, 2.10, 2.31, 3.35, 1.81},
                                 {7.93, 6.24, 5.59, 3.04, 2.23},
                                 {63.45, 78.00, 80.77, 91.99, 117.37}}),
                      request);
}

json mlsmTable2(const Request& request) {
    return stageTable("street",
                      stageRows({{1.78, 1.78, 1.78, 1.78, 1.78},
                                 {0.98, 0.98, 0.98, 0.98, 0.98},
                                 {0.27, 0.27, 0.27, 0.27, 0.27},
                                 {1.85, 1.85, 1.85, 1.85, 1.85},
                                 {0.60, 0.60, 0.60, 0.60, 0.60},
                                 {5.40, 1.87, 3.78, 5.40, 1.66},
                                 {7.71, 5.17, 5.81, 2.54, 2.16},
                                 {53.7, 79.7, 68.8, 73.2, 104.9}}),
                      request);
}

json mlsmTable3(const Request& request) {
    const struct {
        int width, height;
        double paper[2][2];  ///< [pyramid, stack][hall, street], frames per second
    } sizes[] = {{1280, 720, {{117.4, 104.9}, {101.2, 86.4}}},
                 {1920, 1080, {{90.2, 84.2}, {80.8, 77.9}}}};
    const std::vector<int> widths{10, 12, 18, 18};
    fmt::print(
        "Frames per second with epsilon=10, 5 levels and half resolution, whatever --size says; in "
        "brackets the paper's, of a GeForce Titan\n");
    printRow({"size", "levels", "hall", "street"}, widths);
    json rows = json::array();
    for (const auto& size : sizes) {
        auto one = request;
        one.width = size.width;
        one.height = size.height;
        std::vector<report::Comparison> scenes;
        for (const char* scene : {"hall", "street"})
            scenes.push_back(compareOn(
                scene, fmt::format("{}-{}", scene, size.height),
                {std::string(kAll) + ":stackFrom=0", std::string(kAll) + ":stackFrom=128"}, "none",
                one, baseOptions(one, 128)));
        for (std::size_t i = 0; i < 2; ++i) {
            std::vector<std::string> cells{fmt::format("{}x{}", size.width, size.height),
                                           i ? "stack 128" : "pyramid"};
            json row = {{"size", cells[0]}, {"levels", cells[1]}};
            for (std::size_t s = 0; s < 2; ++s) {
                const double fps = 1000 / scenes[s].results[i].totalMs;
                cells.push_back(fmt::format("{:.2f} ({:.1f})", fps, size.paper[i][s]));
                row[s ? "street" : "hall"] = fps;
            }
            printRow(cells, widths);
            rows.push_back(row);
        }
    }
    return rows;
}

namespace {

/// Embree's rays to the same number of samples, and how often mlsm fits into their time.
void addEmbree([[maybe_unused]] const char* scene, [[maybe_unused]] double mlsmMs,
               [[maybe_unused]] RenderOptions base, std::vector<std::string>& cells,
               [[maybe_unused]] json& row) {
#ifdef PENUMBRA_EMBREE
    base.scene = sceneFile(scene);
    const auto embree = traceFrame(base, 16, 8);
    cells.push_back(fmt::format("{:.0f} ({} threads)", embree.ms, embree.threads));
    cells.push_back(fmt::format("{:.1f} x", embree.ms / mlsmMs));
    row["embree"] = embree.ms;
    row["embreeRays"] = embree.rays;
    row["fasterThanEmbree"] = embree.ms / mlsmMs;
#else
    cells.insert(cells.end(), {"-", "-"});
#endif
}

}  // namespace

json mlsmTable4(const Request& request) {
    const Column columns[] = {{"essm", "essm"},
                              {"mlsm", "mlsm"},
                              {"mlsm 2k", "mlsm:resolution=2048"},
                              {"mlsm 512", "mlsm:resolution=512"},
                              {"raytrace", "raytrace"}};
    const struct {
        const char* scene;
        double paper[5];
    } scenes[] = {{"hall", {5.2, 8.5, 45, 5.7, 2100}},
                  {"foliage", {5.5, 6.1, 28, 4.4, 1800}},
                  {"street", {6.7, 9.5, 38, 8.5, 1600}}};
    const std::vector<int> widths{8, 16, 16, 16, 16, 18, 24, 9, 9};
    fmt::print(
        "Milliseconds of shadows, 128 light samples; in brackets the paper's frames, of a GeForce "
        "Titan at 1280x720 and, for rays, of Optix\n");
    std::vector<std::string> header{"scene"};
    for (const auto& column : columns) header.emplace_back(column.name);
    for (const char* more : {"Embree packets", "/ mlsm", "FLIP"}) header.emplace_back(more);
    printRow(header, widths);
    json rows = json::array();
    for (const auto& s : scenes) {
        auto base = baseOptions(request, 128);
        const auto comparison = compareOn(s.scene, std::string(s.scene) + "-rivals",
                                          techniquesOf({std::begin(columns), std::end(columns)}),
                                          "raytrace:samples=128", request, base);
        std::vector<std::string> cells{s.scene};
        json row = {{"scene", s.scene}};
        for (std::size_t i = 0; i < std::size(columns); ++i) {
            const double ms = shadowMs(comparison.results[i]);
            cells.push_back(fmt::format("{:.0f} ({:.1f})", ms, s.paper[i]));
            row[columns[i].name] = ms;
        }
        addEmbree(s.scene, shadowMs(comparison.results[1]), base, cells, row);
        const double flip = comparison.results[1].error.flip;
        cells.push_back(fmt::format("{:.4f}", flip));
        row["flip"] = flip;
        printRow(cells, widths);
        rows.push_back(row);
    }
    return rows;
}

}  // namespace penumbra::papers
