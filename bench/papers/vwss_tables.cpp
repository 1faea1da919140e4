// SPDX-License-Identifier: MIT
// Tables 1 and 2 of [VWSS]: milliseconds and error of mvr, vwss and pcss on four scenes.
#include "bench/papers/papers.h"
#include "runtime/error.h"

namespace penumbra::papers {
namespace {

using nlohmann::json;

/// A row of the paper: GeForce GTX Titan X, milliseconds.
struct PaperRow {
    const char* scene;
    const char* technique;
    int triangles, points;
    double gbuffer, pointGeneration, depthMaps, lighting, total, deviation, rmse;
};

constexpr PaperRow kTable1[] = {
    {"challenger", "mvr", 90007, 40541, 0.261, 0, 0.860, 1.300, 2.421, 0.161, 1.497},
    {"challenger", "vwss", 90007, 40541, 0.262, 0.115, 0.286, 1.259, 1.922, 0.421, 1.801},
    {"challenger", "pcss", 90007, 40541, 0.262, 0, 0.021, 1.590, 1.873, 0.092, 2.753},
    {"volund", "mvr", 240186, 57188, 0.300, 0, 1.358, 1.308, 2.966, 0.149, 1.995},
    {"volund", "vwss", 240186, 57188, 0.293, 0.109, 0.261, 1.272, 1.935, 0.131, 1.428},
    {"volund", "pcss", 240186, 57188, 0.291, 0, 0.052, 1.767, 2.110, 0.105, 2.503},
    {"warriors", "mvr", 510523, 101002, 0.400, 0, 4.095, 1.280, 5.775, 0.298, 1.437},
    {"warriors", "vwss", 510523, 101002, 0.397, 0.471, 0.342, 1.120, 2.330, 0.481, 1.627},
    {"warriors", "pcss", 510523, 101002, 0.394, 0, 0.157, 2.060, 2.611, 0.144, 3.608},
    {"cliffside", "mvr", 672927, 347060, 0.683, 0, 5.148, 1.271, 7.102, 0.540, 1.129},
    {"cliffside", "vwss", 672927, 347060, 0.660, 0.746, 0.636, 1.261, 3.303, 0.575, 1.316},
    {"cliffside", "pcss", 672927, 347060, 0.681, 0, 0.153, 2.246, 3.080, 0.161, 3.232},
};

constexpr PaperRow kTable2[] = {
    {"challenger", "mvr", 90007, 40541, 0.261, 0, 5.396, 7.822, 13.485, 1.709, 0.407},
    {"challenger", "vwss", 90007, 40541, 0.262, 0.115, 1.118, 7.757, 9.260, 0.943, 0.774},
    {"challenger", "pcss", 90007, 40541, 0.262, 0, 0.021, 1.590, 1.873, 0.092, 2.753},
    {"volund", "mvr", 240186, 57188, 0.300, 0, 10.816, 8.242, 19.371, 2.928, 0.411},
    {"volund", "vwss", 240186, 57188, 0.293, 0.109, 1.216, 7.952, 9.588, 0.795, 0.772},
    {"volund", "pcss", 240186, 57188, 0.291, 0, 0.052, 1.767, 2.110, 0.105, 2.503},
    {"warriors", "mvr", 510523, 101002, 0.400, 0, 22.101, 7.469, 29.990, 5.876, 0.403},
    {"warriors", "vwss", 510523, 101002, 0.397, 0.471, 1.253, 6.938, 9.098, 0.440, 0.702},
    {"warriors", "pcss", 510523, 101002, 0.394, 0, 0.157, 2.060, 2.611, 0.144, 3.608},
    {"cliffside", "mvr", 672927, 347060, 0.683, 0, 30.320, 7.679, 38.834, 6.243, 0.255},
    {"cliffside", "vwss", 672927, 347060, 0.660, 0.746, 2.910, 6.823, 11.525, 0.821, 1.129},
    {"cliffside", "pcss", 672927, 347060, 0.681, 0, 0.153, 2.246, 3.080, 0.161, 3.232},
};

/// What we measure of a technique, in the paper's columns.
struct Measured {
    double gbuffer, pointGeneration, depthMaps, lighting, total;
    /// Depth maps with the points they are made of.
    double depth() const { return pointGeneration + depthMaps; }
};

Measured measuredOf(const report::ContenderResult& r) {
    Measured m{};
    m.gbuffer = stageMs(r, {"raster", "resolve"});
    m.pointGeneration = stageMs(r, {"points"});
    m.depthMaps = stageMs(r, {"depth maps", "tree"});
    m.lighting = stageMs(r, {"lighting", "rays", "shading"});
    m.total = m.gbuffer + m.pointGeneration + m.depthMaps + m.lighting;
    return m;
}

const std::vector<int> kWidths{11, 17, 8, 8, 9, 8, 9, 9, 8, 8, 8, 7};

void printHeader() {
    printRow({"scene", "technique", "points", "G-buf", "points", "maps", "lighting", "total", "SD",
              "x depth", "x total", "RMSE"},
             kWidths);
}

std::string ms(double value) {
    return value > 0 ? fmt::format("{:.3f}", value) : "-";
}

void printPaper(const PaperRow& row, const PaperRow& mvr) {
    const double depth = row.pointGeneration + row.depthMaps;
    const bool vwss = std::string(row.technique) == "vwss";
    printRow({"", std::string(row.technique) + " (paper)", vwss ? std::to_string(row.points) : "",
              ms(row.gbuffer), ms(row.pointGeneration), ms(row.depthMaps), ms(row.lighting),
              ms(row.total), ms(row.deviation),
              vwss ? fmt::format("{:.2f}", mvr.depthMaps / depth) : "-",
              vwss ? fmt::format("{:.2f}", mvr.total / row.total) : "-",
              fmt::format("{:.3f}", row.rmse)},
             kWidths);
}

json rowJson(const std::string& scene, const report::ContenderResult& r, const Measured& m,
             double xDepth, double xTotal) {
    return {{"scene", scene},
            {"technique", r.contender.label},
            {"points", r.points},
            {"gbufferMs", m.gbuffer},
            {"pointsMs", m.pointGeneration},
            {"depthMapsMs", m.depthMaps},
            {"lightingMs", m.lighting},
            {"totalMs", m.total},
            {"deviationMs", deviation(r)},
            {"timesFasterDepth", xDepth},
            {"timesFasterTotal", xTotal},
            {"rmse255", r.error.frameRmse255},
            {"flip", r.error.frameFlip}};
}

json runTable(const PaperRow (&paper)[12], int maps, const Request& request) {
    fmt::print("Milliseconds; x: mvr in its textbook form over this technique; RMSE: 8-bit levels of the shaded "
               "frame against mvr with 512 maps.\n");
    printHeader();
    json rows = json::array();
    const std::vector<std::string> techniques{"mvr:form=textbook", "mvr", "vwss", "pcss", "raytrace"};
    for (std::size_t first = 0; first < 12; first += 3) {
        const std::string scene = paper[first].scene;
        const auto comparison =
            compareOn(scene, fmt::format("{}-{}", scene, maps), techniques, "mvr:samples=512",
                      request, baseOptions(request, maps));
        const auto textbook = measuredOf(comparison.results[0]);
        for (const auto& r : comparison.results) {
            const auto m = measuredOf(r);
            const bool first_ = &r == &comparison.results[0];
            const double xDepth = m.depth() > 0 ? textbook.depth() / m.depth() : 0;
            const double xTotal = textbook.total / m.total;
            printRow({first_ ? scene : "", r.contender.label,
                      r.points ? std::to_string(r.points) : "", ms(m.gbuffer),
                      ms(m.pointGeneration), ms(m.depthMaps), ms(m.lighting), ms(m.total),
                      ms(deviation(r)), xDepth > 0 ? fmt::format("{:.2f}", xDepth) : "-",
                      fmt::format("{:.2f}", xTotal), fmt::format("{:.3f}", r.error.frameRmse255)},
                     kWidths);
            rows.push_back(rowJson(scene, r, m, xDepth, xTotal));
        }
        for (std::size_t i = first; i < first + 3; ++i) printPaper(paper[i], paper[first]);
    }
    return rows;
}

}  // namespace

json vwssTable1(const Request& request) {
    return runTable(kTable1, 24, request);
}

json vwssTable2(const Request& request) {
    return runTable(kTable2, 128, request);
}

}  // namespace penumbra::papers
