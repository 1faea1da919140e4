// SPDX-License-Identifier: MIT
// Table 1 of [MVSS]: 28 maps, two and six characters.
#include "bench/papers/papers.h"
#include "runtime/error.h"

namespace penumbra::papers {

nlohmann::json mvssTable1(const Request& request) {
    const std::vector<int> widths{11, 10, 7, 10, 10, 10, 9, 9};
    fmt::print(
        "Milliseconds at 1920x1200, whatever --size says; drawn: triangles that some view may "
        "show, of 12,086 and 36,258. The paper (GeForce GTX 580, 512^2): 12,086 triangles 0.3 + "
        "1.9 "
        "= 2.2; 36,258 "
        "triangles 0.9 + 2.4 = 3.3\n");
    printRow({"scene", "drawn", "maps of", "maps", "shading", "total", "maps %", "maps MB"},
             widths);
    nlohmann::json rows = nlohmann::json::array();
    auto large = request;
    large.width = 1920;
    large.height = 1200;
    for (const char* scene : {"mvss2", "mvss6"})
        for (const int size : {512, 1024}) {
            const auto comparison = compareOn(scene, fmt::format("{}-{}", scene, size),
                                              {fmt::format("mvss:resolution={}", size)}, "none",
                                              large, baseOptions(large, 28));
            const auto& r = comparison.results[0];
            const double maps = stageMs(r, {"depth maps"});
            const double shading = stageMs(r, {"lighting", "shading"});
            const double megabytes = static_cast<double>(r.mapBytes) / 1048576;
            printRow({scene, std::to_string(r.mapTriangles), std::to_string(size),
                      fmt::format("{:.2f}", maps), fmt::format("{:.2f}", shading),
                      fmt::format("{:.2f}", maps + shading),
                      fmt::format("{:.0f}", 100 * maps / (maps + shading)),
                      fmt::format("{:.0f}", megabytes)},
                     widths);
            rows.push_back({{"scene", scene},
                            {"mapTriangles", r.mapTriangles},
                            {"resolution", size},
                            {"mapsMs", maps},
                            {"shadingMs", shading},
                            {"megabytes", megabytes}});
        }
    return rows;
}

}  // namespace penumbra::papers
