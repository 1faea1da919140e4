// SPDX-License-Identifier: MIT
// The command as a user runs it.
#pragma once
#include <string>

namespace penumbra::tests {

struct Result {
    int code = -1;  ///< of the shell: 128 more than its number where a signal ended the command
    std::string output, errors;
};

std::string readFile(const std::string& path);

/// Runs `penumbra ARGUMENTS` in a shell; `before` as "VARIABLE=value" or "ulimit -f 1;".
Result run(const std::string& arguments, const std::string& before = "");

}  // namespace penumbra::tests
