// SPDX-License-Identifier: MIT
// Whole frames of the built-in scene at 1280 x 720, every technique, by light samples and settings.
#include <map>
#include <nlohmann/json.hpp>

#include "bench/support/bench.h"
#include "host/pipeline.h"
#include "host/visibility/technique.h"

namespace penumbra::bench {
namespace {

void wholeFrame(benchmark::State& state, const std::string& technique, SettingValues settings,
                int samples) {
    RenderOptions options;
    options.technique = technique;
    options.settings = std::move(settings);
    options.lightSamples = std::to_string(samples);
    options.profile = true;
    Pipeline pipeline(options);
    pipeline.render(0);
    int number = 1;
    std::map<std::string, double> stages;
    for (auto _ : state) {
        const auto stats = nlohmann::json::parse(pipeline.render(number++).statsJson);
        double ms = 0;
        for (const auto& stage : stats["stages"]) {
            ms += stage["deviceMs"].get<double>();
            stages[stage["name"]] += stage["deviceMs"].get<double>();
        }
        state.SetIterationTime(1e-3 * ms);
    }
    for (const auto& [name, ms] : stages)
        state.counters[name] = ms / static_cast<double>(state.iterations());
    state.SetItemsProcessed(state.iterations() * 1280 * 720);
    state.SetLabel(pipeline.device().info().name);
}

const int registered = [] {
    const auto add = [](const std::string& name, const std::string& technique,
                        const SettingValues& settings, int samples) {
        benchmark::RegisterBenchmark(
            name.c_str(),
            [=](benchmark::State& state) { wholeFrame(state, technique, settings, samples); })
            ->UseManualTime()
            ->Unit(benchmark::kMillisecond);
    };
    for (const auto& entry : visibility::techniques())
        for (const int samples : {24, 128})
            add(fmt::format("frame/{}/samples:{}", entry.name, samples), entry.name, {}, samples);
    // Lighting by filter: see the counter of that name
    for (const char* pcf : {"1", "5", "9", "bilinear"})
        add(fmt::format("frame/vwss/samples:24/pcf:{}", pcf), "vwss", {{"vwss.pcf", pcf}}, 24);
    add("frame/vwss/samples:24/16bit", "vwss", {{"vwss.depthBits", "16"}}, 24);
    add("frame/vwss/samples:24/half", "vwss", {{"vwss.halfResolution", "true"}}, 24);
    return 0;
}();

}  // namespace
}  // namespace penumbra::bench
