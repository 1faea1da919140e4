// SPDX-License-Identifier: MIT
// The public interface over the pipeline.
#include <new>
#include <nlohmann/json.hpp>

#include "host/penumbra.h"
#include "host/pipeline.h"
#include "runtime/error.h"

namespace penumbra {

struct Renderer::State {
    explicit State(const RenderOptions& options) : pipeline(options) {}
    Pipeline pipeline;
};

Renderer::Renderer(const RenderOptions& options) : state_(std::make_unique<State>(options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Frame Renderer::render(int number) {
    return state_->pipeline.render(number);
}
int Renderer::frameCount() const {
    return state_->pipeline.frameCount();
}
std::vector<std::string> Renderer::takeWarnings() {
    return state_->pipeline.takeWarnings();
}
std::string Renderer::deviceName() const {
    return state_->pipeline.device().info().name;
}
std::string Renderer::fingerprint() const {
    return state_->pipeline.fingerprint();
}
std::string Renderer::statsJson() const {
    return state_->pipeline.statsJson();
}

std::string devicesJson(const std::string& requested) {
    const auto devices = runtime::listDevices();
    std::size_t chosen = devices.size();
    std::string why;
    try {
        const auto choice = runtime::chooseDevice(devices, requested);
        chosen = choice.index;
        why = choice.why;
    } catch (const Error& error) {
        why = error.what();
    }
    nlohmann::json list = nlohmann::json::array();
    for (std::size_t i = 0; i < devices.size(); ++i) {
        const auto& d = devices[i];
        list.push_back({{"index", i},
                        {"platform", d.platform},
                        {"name", d.name},
                        {"vendor", d.vendor},
                        {"driver", d.driver},
                        {"version", d.version},
                        {"kind", d.isGpu   ? "gpu"
                                 : d.isCpu ? "cpu"
                                           : "other"},
                        {"computeUnits", d.computeUnits},
                        {"clockMhz", d.clockMhz},
                        {"globalBytes", d.globalBytes},
                        {"maxAllocBytes", d.maxAllocBytes},
                        {"localBytes", d.localBytes},
                        {"atomics64", d.atomics64},
                        {"lanes", d.lanes},
                        {"usable", d.usable},
                        {"note", d.whyNot},
                        {"chosen", i == chosen}});
    }
    nlohmann::json result = {
        {"devices", list}, {"why", why}, {"searched", runtime::icdSearchPath()}};
    return result.dump(2);
}

std::string techniquesJson() {
    nlohmann::json list = nlohmann::json::array();
    for (const auto& entry : visibility::techniques()) {
        nlohmann::json rows = nlohmann::json::array();
        for (const auto& row : entry.describe())
            rows.push_back({{"name", row.name},
                            {"kind", row.kind},
                            {"default", row.fallback},
                            {"lowest", row.lowest},
                            {"highest", row.highest},
                            {"choices", row.choices},
                            {"unit", row.unit},
                            {"meaning", row.meaning},
                            {"reachesDevice", row.reachesDevice}});
        list.push_back({{"name", entry.name},
                        {"summary", entry.summary},
                        {"source", entry.source},
                        {"failures", entry.failures},
                        {"settings", rows}});
    }
    return nlohmann::json({{"techniques", list}}).dump(2);
}

int exitCodeOf(const std::exception& error) {
    if (const auto* own = dynamic_cast<const Error*>(&error)) return static_cast<int>(own->code());
    if (dynamic_cast<const std::bad_alloc*>(&error)) return static_cast<int>(ExitCode::outOfMemory);
    return static_cast<int>(ExitCode::failed);
}

const char* version() {
    return PENUMBRA_VERSION;
}

}  // namespace penumbra
