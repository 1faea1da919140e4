// SPDX-License-Identifier: MIT
// What a pipeline says of its frames: what made them (file headers), what they took (--stats).
#include <nlohmann/json.hpp>

#include "host/pipeline.h"
#include "runtime/error.h"

namespace penumbra {

std::vector<std::pair<std::string, std::string>> Pipeline::makeHeader() const {
    std::vector<std::pair<std::string, std::string>> entries;
    const auto add = [&](const std::string& key, const std::string& value) {
        entries.emplace_back(key, value);
    };
    add("version", version());
    add("technique", options_.technique);
    for (const auto& row : technique_->settings())
        add(options_.technique + "." + row.name, row.fallback);
    add("lightSamples", options_.lightSamples);
    add("lightPattern", options_.lightPattern);
    add("seed", options_.seed);
    add("size", fmt::format("{}x{}", options_.width, options_.height));
    add("supersample", fmt::format("{}", options_.supersample));
    add("fps", fmt::format("{}", options_.fps));
    add("animation", options_.animation);
    add("camera", options_.camera);
    if (options_.eye) add("eye", fmt::format("{}", fmt::join(*options_.eye, ",")));
    if (options_.target) add("target", fmt::format("{}", fmt::join(*options_.target, ",")));
    if (options_.fovDegrees) add("fov", fmt::format("{}", *options_.fovDegrees));
    add("ground", options_.ground ? "true" : "false");
    if (!options_.lights.empty()) add("lights", fmt::format("{}", fmt::join(options_.lights, " ")));
    add("temporal", fmt::format("{}", options_.temporal));
    add("exposure", options_.exposure);
    add("gain", fmt::format("{:.9g}", exposure_));  // what exposure came to; diff shows EXR with it
    add("aovs", fmt::format("{}", fmt::join(options_.aovs, ",")));
    add("device", device_->info().name);
    add("driver", device_->info().platform + " " + device_->info().driver);
    return entries;
}

std::string Pipeline::frameStats(const std::vector<runtime::StageTime>& stages, int number,
                                 double wallMs, int retries) {
    const auto counts = technique_->takeCounts();
    nlohmann::json json = {{"frame", number},
                           {"wallMs", wallMs},
                           {"triangles", geometry_->mesh().triangleCount},
                           {"points", counts.points},
                           {"mapTriangles", counts.mapTriangles},
                           {"mapBytes", counts.mapBytes},
                           {"nearPoints", counts.nearPoints},
                           {"outsideFov", counts.outsideFov},
                           {"blendedFragments", gbuffer_->fragmentCounts().fragments},
                           {"blendedLayers", gbuffer_->fragmentCounts().layers},
                           {"bytes", device_->memory().current},
                           {"retries", retries},
                           {"dropped", geometry_->counts().nonFiniteVertices}};
    for (const auto& s : stages)
        json["stages"].push_back({{"name", s.name},
                                  {"deviceMs", s.deviceMs},
                                  {"wallMs", s.wallMs},
                                  {"launches", s.launches},
                                  {"maxLaunchMs", s.maxLaunchMs}});
    if (!device_->profiler().timestampsWork())
        warnOnce(
            fmt::format("the timestamps of device {} are zero: stages are timed by the wall clock, "
                        "one launch at a time",
                        device_->info().name));
    if (const auto dropped = geometry_->counts().nonFiniteVertices)
        warnOnce(
            fmt::format("{} vertices are not finite or too far away: their triangles are dropped",
                        dropped),
            "vertices that are not finite");
    if (counts.nearPoints)
        warnOnce(
            fmt::format(
                "casters lie nearer to a light than its near plane: {} points keep depth 1; set "
                "near= on --light",
                counts.nearPoints),
            "points before the near plane");
    return json.dump();
}

std::string Pipeline::statsJson() const {
    nlohmann::json settings;
    for (const auto& [key, value] : header_) settings[key] = value;
    const auto& programs = device_->programs();
    return nlohmann::json(
               {{"schema", 1},
                {"device", device_->info().name},
                {"settings", settings},
                {"programs",
                 {{"built", programs.built}, {"loaded", programs.loaded}, {"ms", programs.ms}}},
                {"memory", {{"peak", device_->memory().peak}, {"planned", plannedBytes_}}}})
        .dump();
}

}  // namespace penumbra
