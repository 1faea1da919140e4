// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "host/report/comparison.h"
#include "runtime/error.h"

namespace penumbra::report {
namespace {

using nlohmann::json;

json orNull(const std::optional<double>& value) {
    return value ? json(*value) : json();
}

json errorJson(const FrameError& e) {
    return {{"rmse", e.rmse},
            {"max", e.maximum},
            {"mean", e.mean},
            {"flip", e.flip},
            {"share", {{"4", e.share4}}},
            {"frame", {{"rmse255", e.frameRmse255}, {"flip", e.frameFlip}, {"ssim", e.frameSsim}}}};
}

json resultJson(const ContenderResult& r) {
    json stages = json::array();
    for (const auto& name : r.stageOrder)
        stages.push_back({{"name", name}, {"ms", r.stageMs.at(name)}});
    json frames = json::array();
    for (const auto& f : r.frames)
        frames.push_back({{"frame", f.number},
                          {"ms", f.ms},
                          {"totalMs", f.totalMs},
                          {"rmse", f.reference.rmse},
                          {"flip", f.reference.flip},
                          {"flicker", orNull(f.flicker)}});
    json result = {{"technique", r.contender.label},
                   {"settings", r.settings},
                   {"ms", {{"total", r.totalMs}, {"shadows", r.ms}, {"stages", stages}}},
                   {"error",
                    {{"reference", errorJson(r.error)},
                     {"sameSamples", orNull(r.sameSamples)},
                     {"of", r.ofVisibility ? "visibility" : "picture"}}},
                   {"flicker", orNull(r.flicker)},
                   {"points", r.points},
                   {"mapTriangles", r.mapTriangles},
                   {"mapBytes", r.mapBytes},
                   {"bytes", r.bytes},
                   {"frames", frames},
                   {"files", r.files}};
    result["fasterThanMvr"] = orNull(r.fasterThanMvr);
    if (r.sweepValue) result["value"] = *r.sweepValue;
    return result;
}

}  // namespace

std::string resultsJson(const Comparison& c) {
    json results = json::array(), sweep = json::array();
    for (const auto& r : c.results) results.push_back(resultJson(r));
    for (const auto& r : c.sweep) sweep.push_back(resultJson(r));
    const auto samples = c.reference.settings.find("lightSamples");
    json document = {
        {"schema", 1},
        {"version", version()},
        {"command", c.options.command},
        {"scene", c.options.base.scene.empty() ? "built-in" : c.options.base.scene},
        {"device", {{"name", c.device}, {"driver", c.driver}}},
        {"size", {c.width, c.height}},
        {"frames", c.options.frames},
        {"shownFrame", c.shownFrame},
        {"reference",
         {{"technique", c.options.reference},
          {"samples", samples == c.reference.settings.end() ? json() : json(samples->second)},
          {"flicker", orNull(c.reference.flicker)},
          {"files", c.reference.files}}},
        {"results", results},
        {"warnings", c.warnings}};
    if (!sweep.empty()) document["sweep"] = {{"what", c.options.sweep}, {"results", sweep}};
    return document.dump(2) + "\n";
}

}  // namespace penumbra::report
