// SPDX-License-Identifier: MIT
#include <algorithm>

#include "host/report/comparison.h"
#include "host/scene/light.h"
#include "host/visibility/technique.h"
#include "runtime/error.h"

namespace penumbra::report {

Contender parseContender(const std::string& text, const RenderOptions& base) {
    Contender contender{text, base};
    auto& options = contender.options;
    std::size_t begin = text.find(':');
    options.technique = text.substr(0, begin);
    visibility::findTechnique(options.technique);
    while (begin != std::string::npos) {
        const auto end = text.find(':', ++begin);
        const std::string item = text.substr(begin, end - begin);
        const auto equals = item.find('=');
        requireUsage(equals != std::string::npos && equals > 0,
                     "'{}' of technique '{}' is not setting=value", item, text);
        const std::string key = item.substr(0, equals), value = item.substr(equals + 1);
        if (key == "samples")
            options.lightSamples = value;
        else if (key == "pattern")
            options.lightPattern = value;
        else if (key == "seed")
            options.seed = value;
        else if (key == "temporal")
            try {
                options.temporal = std::stoi(value);
            } catch (const std::exception&) {
                throw Error(fmt::format("'{}': temporal={} is not a number", text, value),
                            ExitCode::usage);
            }
        else
            options.settings[options.technique + "." + key] = value;
        begin = end;
    }
    // Settings of other techniques are for other contenders
    std::erase_if(options.settings, [&](const auto& setting) {
        return setting.first.rfind(options.technique + ".", 0) != 0;
    });
    return contender;
}

void checkContender(const Contender& contender, const std::string& samplesOption) {
    const auto& options = contender.options;
    const auto& technique = visibility::findTechnique(options.technique);
    const auto rows = technique.describe();
    std::vector<std::string> names;
    names.reserve(rows.size());
    for (const auto& row : rows) names.push_back(row.name);
    for (const auto& [key, value] : options.settings) {
        const auto name = key.substr(key.find('.') + 1);
        requireUsage(std::find(names.begin(), names.end(), name) != names.end(),
                     "'{}': {} has no setting '{}'; allowed: {}, samples, pattern, seed, temporal",
                     contender.label, options.technique, name, fmt::join(names, ", "));
    }
    technique.check(options.technique, options.settings);
    requireUsage(options.lightPattern != "random" || options.technique == "raytrace",
                 "'{}': pattern random is for raytrace alone; allowed: hammersley, poisson, grid, "
                 "jittered",
                 contender.label);
    scene::SampleChoice choice;
    choice.pattern = scene::parsePattern(options.lightPattern);
    scene::parseSampleCount(options.lightSamples, choice, samplesOption);
}

}  // namespace penumbra::report
