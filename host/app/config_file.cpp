// SPDX-License-Identifier: MIT
#include "host/app/config_file.h"

#include <filesystem>
#include <fstream>

#include "runtime/error.h"

namespace penumbra::app {
namespace {

bool isGiven(const CLI::Option& option, const std::vector<std::string>& arguments) {
    for (const auto& name : option.get_lnames())
        for (const auto& argument : arguments)
            if (argument == "--" + name || argument.rfind("--" + name + "=", 0) == 0) return true;
    for (const auto& name : option.get_snames())
        for (const auto& argument : arguments)
            if (argument.rfind("-" + name, 0) == 0 && argument.rfind("--", 0) != 0) return true;
    return false;
}

std::string configPath(const std::vector<std::string>& arguments) {
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (arguments[i] == "--config" && i + 1 < arguments.size()) return arguments[i + 1];
        if (arguments[i].rfind("--config=", 0) == 0) return arguments[i].substr(9);
    }
    return "";
}

/// CLI11's reader, whose complaints become ours.
std::vector<CLI::ConfigItem> readItems(const std::string& path) try {
    std::ifstream file(path);
    require(std::filesystem::is_regular_file(path) && file, "--config {}: cannot be read", path);
    return CLI::ConfigTOML().from_config(file);
} catch (const CLI::Error& error) {
    throw Error(fmt::format("--config {}: {}", path, error.what()), ExitCode::usage);
}

}  // namespace

std::vector<std::string> withConfig(const std::vector<std::string>& arguments,
                                    const CLI::App& render) {
    const std::string path = configPath(arguments);
    if (path.empty()) return arguments;
    auto all = std::vector<std::string>{arguments[0]};
    for (const auto& item : readItems(path)) {
        if (item.name == "++" || item.name == "--") continue;  // where CLI11 saw a section
        const auto* option = render.get_option_no_throw("--" + item.name);
        requireUsage(option != nullptr && item.parents.empty() && item.name != "config",
                     "--config {}: '{}' is not an option of render; see penumbra render --help",
                     path, item.fullname());
        // Settings of the file and of the command line add up, key by key; the later one wins
        if (isGiven(*option, arguments) && item.name != "set") continue;
        if (option->get_expected_min() == 0) {
            requireUsage(item.inputs == std::vector<std::string>{"true"} ||
                             item.inputs == std::vector<std::string>{"false"},
                         "--config {}: {} is not true or false", path, item.name);
            if (item.inputs[0] == "true") all.push_back("--" + item.name);
            continue;
        }
        if (option->get_delimiter() != '\0')
            all.push_back(fmt::format("--{}={}", item.name, fmt::join(item.inputs, ",")));
        else
            for (const auto& input : item.inputs) all.push_back("--" + item.name + "=" + input);
    }
    all.insert(all.end(), arguments.begin() + 1, arguments.end());
    return all;
}

}  // namespace penumbra::app
