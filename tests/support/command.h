// SPDX-License-Identifier: MIT
// The command as a user runs it, through a shell.
#pragma once
#include <string>

namespace penumbra::tests {

struct Result {
    int code = -1;  ///< that of the command; 128 + signal where one ended it
    std::string output, errors;
};

Result run(const std::string& arguments);

std::string readFile(const std::string& path);

}  // namespace penumbra::tests
