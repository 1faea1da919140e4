// SPDX-License-Identifier: MIT
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace penumbra::app {

/// Arguments of render with those of the --config file added that the command line does not give.
/// CLI11's own configuration works for the whole program, not for one of its commands. Throws Error
/// (usage) that names file and option.
std::vector<std::string> withConfig(const std::vector<std::string>& arguments,
                                    const CLI::App& render);

}  // namespace penumbra::app
