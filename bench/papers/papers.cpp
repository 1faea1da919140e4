// SPDX-License-Identifier: MIT
#include "bench/papers/papers.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "runtime/error.h"

namespace penumbra::papers {

const std::vector<Table>& tables() {
    static const std::vector<Table> list = {
        {"goals", "what must hold: figure, floor and goal; exit code 1 where a floor is missed",
         goals},
        {"analytic", "every technique against closed forms: half-planes, sphere, box, series",
         analytic},
        {"vwss-table1", "[VWSS] table 1: cost and error with 24 depth maps, four scenes",
         vwssTable1},
        {"vwss-table2", "[VWSS] table 2: the same with 128 depth maps", vwssTable2},
        {"vwss-fig8", "[VWSS] figure 8: vwss and mvr as the light grows to 64 times its area",
         vwssFigure8},
        {"vwss-fig9", "[VWSS] figure 9: vwss and pcss on warriors and cliffside", vwssFigure9},
        {"vwss-fig10", "[VWSS] figure 10: pcss, vwss and mvr on the thin parts of challenger",
         vwssFigure10},
        {"vwss-fig13", "[VWSS] figure 13: buffered and unbuffered, serial, partial and full",
         vwssFigure13},
        {"mvss-table1", "[MVSS] table 1: 28 maps, two and six characters, 1920x1200", mvssTable1},
#ifdef PENUMBRA_EMBREE
        {"4dr-table1",
         "[4DR] table 1: raster4d over Embree, six scenes, 512^2 to 1280^2 "
         "(--size 512x512: that alone)",
         fourdTable1},
        {"4dr-table2", "[4DR] table 2: what each of the grid's switches brings", fourdTable2},
        {"4dr-table3", "[4DR] table 3: milliseconds of the steps", fourdTable3},
        {"4dr-table4", "[4DR] table 4: 8x8 to 64x64 light samples", fourdTable4},
        {"4dr-table5", "[4DR] table 5: light diagonals 1 to 5", fourdTable5},
        {"4dr-table6", "[4DR] table 6: grids of 256 to 32", fourdTable6},
        {"4dr-table8", "[4DR] table 8: rays in equal time", fourdTable8},
        {"4dr-exactness", "bits of raster4d that differ from Embree's, decided in double",
         fourdExactness},
#endif
        {"mlsm-table1", "[MLSM] table 1: stages of mlsm by its settings, hall", mlsmTable1},
        {"mlsm-table2", "[MLSM] table 2: the same, street", mlsmTable2},
        {"mlsm-table3", "[MLSM] table 3: pyramid and stack at two sizes, hall and street",
         mlsmTable3},
        {"mlsm-table4", "[MLSM] table 4: essm, mlsm by resolution and rays, three scenes",
         mlsmTable4},
    };
    return list;
}

namespace {

/// A folder of this process, gone with it.
const std::filesystem::path& temporaryFolder() {
    static const struct Folder {
        std::filesystem::path path;
        Folder() {
            std::string name = (std::filesystem::temp_directory_path() / "papersXXXXXX").string();
            require(mkdtemp(name.data()) != nullptr, "{} cannot be made", name);
            path = name;
        }
        ~Folder() {
            std::error_code ignored;
            std::filesystem::remove_all(path, ignored);
        }
    } folder;
    return folder.path;
}

void printProgress(const std::string& line) {
    std::fprintf(stderr, "  %s\n", line.c_str());
}

}  // namespace

std::string sceneFile(const std::string& name) {
    const auto path = temporaryFolder() / (name + ".glb");
    if (!std::filesystem::exists(path)) {
        const std::string command =
            fmt::format("'{}' '{}' {} > '{}'", PENUMBRA_MAKE_SCENE, path.string(), name,
                        (temporaryFolder() / "log").string());
        require(std::system(command.c_str()) == 0, "the scene {} could not be made by {}", name,
                PENUMBRA_MAKE_SCENE);
    }
    return path.string();
}

runtime::Device& openDevice(const Request& request) {
    static const auto device = [&] {
        const auto devices = runtime::listDevices();
        runtime::DeviceOptions options;
        options.profiling = true;
        return std::make_unique<runtime::Device>(
            devices[runtime::chooseDevice(devices, request.device).index], options);
    }();
    return *device;
}

RenderOptions baseOptions(const Request& request, int samples) {
    RenderOptions base;
    base.width = request.width;
    base.height = request.height;
    base.device = request.device;
    base.lightSamples = std::to_string(samples);
    base.lightPattern = "poisson";
    return base;
}

report::Comparison compareOn(const std::string& scene, const std::string& name,
                             const std::vector<std::string>& techniques,
                             const std::string& reference, const Request& request,
                             const RenderOptions& base) {
    report::CompareOptions options;
    options.base = base;
    options.base.scene = sceneFile(scene);
    options.techniques = techniques;
    options.reference = reference;
    options.sameSamples = false;
    options.frames.clear();
    for (int i = 0; i < request.frames; ++i) options.frames.push_back(i * 24 / request.frames);
    options.command = "penumbra_papers, scene " + name;
    const bool keep = !request.report.empty();
    options.folder = keep ? (std::filesystem::path(request.report) / name).string()
                          : (temporaryFolder() / name).string();
    auto comparison = report::compare(options, printProgress);
    comparison.options.base.scene = scene;
    if (keep) report::writeReport(comparison);
    return comparison;
}

double stageMs(const report::ContenderResult& result, const std::vector<std::string>& stages) {
    double sum = 0;
    for (const auto& stage : stages) {
        const auto found = result.stageMs.find(stage);
        if (found != result.stageMs.end()) sum += found->second;
    }
    return sum;
}

double deviation(const report::ContenderResult& result) {
    double mean = 0, squares = 0;
    const auto count = static_cast<double>(result.frames.size());
    for (const auto& frame : result.frames) mean += frame.totalMs / count;
    for (const auto& frame : result.frames)
        squares += (frame.totalMs - mean) * (frame.totalMs - mean);
    return count > 1 ? std::sqrt(squares / (count - 1)) : 0;
}

void printRow(const std::vector<std::string>& cells, const std::vector<int>& widths) {
    for (std::size_t i = 0; i < cells.size(); ++i)
        fmt::print("{:>{}} ", cells[i], i < widths.size() ? widths[i] : widths.back());
    fmt::print("\n");
    std::fflush(stdout);
}

}  // namespace penumbra::papers
