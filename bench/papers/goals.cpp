// SPDX-License-Identifier: MIT
// What penumbra promises of its speed and exactness, measured in one go: the figure beside the
// floor below which it must not fall and the goal. Ratios are of one run on one machine.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "bench/papers/papers.h"
#include "runtime/error.h"
#ifdef PENUMBRA_EMBREE
#include "bench/papers/embree_frame.h"
#include "bench/papers/embree_shadows.h"
#endif
#ifdef PENUMBRA_EGL
#include "bench/papers/opengl_rival.h"
#endif

namespace penumbra::papers {
namespace {

using nlohmann::json;

/// A promise. `must` is a floor, or a ceiling where atMost.
struct Goal {
    const char* what;
    double must, goal;
    const char* unit;
    bool atMost = false;
};

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

class Scoreboard {
  public:
    void add(const Goal& goal, double figure) {
        const bool measured = !std::isnan(figure);
        const auto reaches = [&](double limit) {
            return goal.atMost ? figure <= limit : figure >= limit;
        };
        const char* verdict = !measured            ? "not measured"
                              : reaches(goal.goal) ? "goal"
                              : reaches(goal.must) ? "met"
                                                   : "missed";
        rows_.push_back({{"what", goal.what},
                         {"must", goal.must},
                         {"goal", goal.goal},
                         {"unit", goal.unit},
                         {"verdict", verdict}});
        rows_.back()["figure"] = measured ? json(figure) : json();
    }
    const json& print() const {
        fmt::print("\n{:<70} {:>10} {:>10} {:>10}  {}\n", "what", "must", "goal", "figure", "");
        for (const auto& row : rows_) {
            const std::string unit = row["unit"];
            const auto text = [&](const json& value) {
                return value.is_null() ? "-" : fmt::format("{:.3g} {}", value.get<double>(), unit);
            };
            fmt::print("{:<70} {:>10} {:>10} {:>10}  {}\n", row["what"].get<std::string>(),
                       text(row["must"]), text(row["goal"]), text(row["figure"]),
                       row["verdict"].get<std::string>());
        }
        return rows_;
    }

  private:
    json rows_ = json::array();
};

/// The geometric mean of what was measured.
double meanOf(const std::vector<double>& values) {
    if (values.empty()) return kNotMeasured;
    double sum = 0;
    for (const double value : values) sum += std::log(value);
    return std::exp(sum / static_cast<double>(values.size()));
}

double worstOf(const std::vector<double>& values) {
    return values.empty() ? kNotMeasured : *std::min_element(values.begin(), values.end());
}

double depthMs(const report::ContenderResult& r) {
    return stageMs(r, {"points", "depth maps"});
}

/// All that follows the G-buffer.
double frameMs(const report::ContenderResult& r) {
    return stageMs(r, {"points", "depth maps", "lighting", "rays", "tree", "shading"});
}

void viewWarping(const Request& request, Scoreboard& board) {
    // The paper's way on this device: atomics, all maps stored, every pixel tested
    const char* const paper = "vwss:parallelism=full:viewsPerBatch=24:skipLit=false";
    const std::vector<std::string> techniques{"vwss",
                                              "mvr",
                                              "mvr:form=textbook",
                                              paper,
                                              "vwss:samples=128",
                                              "mvr:samples=128",
                                              "mvr:form=textbook:samples=128"};
    std::vector<double> textbook24, textbook128, full24, full128, overPaper, overGl, fps;
    auto one = request;
    one.frames = 1;
    for (const char* scene : {"challenger", "volund", "warriors", "cliffside"}) {
        const auto comparison = compareOn(scene, std::string(scene) + "-goals", techniques, "none",
                                          one, baseOptions(one, 24));
        const auto depth = [&](std::size_t i) { return depthMs(comparison.results[i]); };
        full24.push_back(depth(1) / depth(0));
        textbook24.push_back(depth(2) / depth(0));
        full128.push_back(depth(5) / depth(4));
        textbook128.push_back(depth(6) / depth(4));
        const double frame = frameMs(comparison.results[0]);
        overPaper.push_back(frameMs(comparison.results[3]) / frame);
        fps.push_back(1000 / frame);
#ifdef PENUMBRA_EGL
        overGl.push_back(openGlMs(request, scene, 24) / depth(0));
#endif
    }
    board.add({"vwss: depth maps, points included, over textbook mvr, 24 maps", 40, 60, "x"},
              meanOf(textbook24));
    board.add({"the same, 128 maps", 55, 100, "x"}, meanOf(textbook128));
    board.add({"over mvr with every trick, 24 maps", 3, 5, "x"}, meanOf(full24));
    board.add({"the same, 128 maps", 4, 8, "x"}, meanOf(full128));
    board.add({"over llvmpipe (one thread), worst scene, 24 maps", 150, 300, "x"}, worstOf(overGl));
    board.add({"vwss: frame after the G-buffer over the paper's way, 24 maps, 5 taps", 14, 30, "x"},
              meanOf(overPaper));
    board.add({"frames/s after the G-buffer, 90k triangles", 60, 120, ""}, fps[0]);
    board.add({"frames/s after the G-buffer, 240k triangles", 60, 90, ""}, fps[1]);
    board.add({"frames/s after the G-buffer, 511k triangles", 45, 60, ""}, fps[2]);
    board.add({"frames/s after the G-buffer, 673k triangles", 20, 60, ""}, fps[3]);
}

#ifdef PENUMBRA_EMBREE
/// Embree's time over that of raytrace, 16x16 samples.
double raytraceSpeed(runtime::Device& device, const std::string& scene) {
    MaskView view;
    view.samples = "16x16";
    MaskScene posed(device, sceneFile(scene), view);
    double ours = 0;
    for (const auto& [stage, ms] : posed.run("raytrace", {}, 1))
        if (stage != "tree") ours += ms;
    const EmbreeShadows embree(posed.corners(), false);
    return 1e3 * embree.trace(posed.receivers(), posed.samplePoints(), 16, 16) / ours;
}

void exactMasks(const Request& request, Scoreboard& board) {
    auto one = request;
    one.frames = 1;
    one.width = one.height = 512;
    std::vector<double> speed, share, growth, rays;
    for (const auto& row : fourdTable1(one)) speed.push_back(row["speedupMean"]);
    double wrong = 0;
    for (const auto& row : fourdExactness(one)) {
        share.push_back(std::max(row["different"].get<double>(), 0.1) / row["bits"].get<double>());
        wrong += row["wrong"].get<double>();
    }
    for (const auto& row : fourdTable4(one))
        growth.push_back(row["64x64"].get<double>() / row["32x32"].get<double>());
    for (const auto& paper : fourdScenes()) rays.push_back(raytraceSpeed(openDevice(one), paper));
    board.add({"raster4d over Embree's best packets, its tree for free, six scenes", 24, 40, "x"},
              meanOf(speed));
    board.add({"the same, worst scene", 15, 30, "x"}, worstOf(speed));
    board.add({"raster4d: share of bits unequal to Embree's", 1e-6, 1e-8, "", true}, meanOf(share));
    board.add({"raster4d: unequal bits that are no graze", 0, 0, "", true}, wrong);
    board.add({"raster4d: time of 64x64 over that of 32x32 samples", 2.5, 2, "x", true},
              meanOf(growth));
    board.add({"raytrace over Embree's best packets", 0.3, 0.6, "x"}, meanOf(rays));
}

double hallSpeed(const Request& request) {
    auto base = baseOptions(request, 128);
    const auto comparison = compareOn("hall", "hall-goals", {"mlsm"}, "none", request, base);
    base.scene = sceneFile("hall");
    return traceFrame(base, 16, 8).ms / comparison.results[0].ms;
}
#endif

}  // namespace

json goals(const Request& request) {
    Scoreboard board;
    viewWarping(request, board);
    const Goal hall{"mlsm: hall, 1280x720, over Embree's packets, 128 samples", 5, 20, "x"};
#ifdef PENUMBRA_EMBREE
    exactMasks(request, board);
    auto one = request;
    one.frames = 1;
    board.add(hall, hallSpeed(one));
#else
    board.add({"raster4d over Embree's best packets, its tree for free, six scenes", 24, 40, "x"},
              kNotMeasured);
    board.add(hall, kNotMeasured);
#endif
    return board.print();
}

}  // namespace penumbra::papers
