// SPDX-License-Identifier: MIT
#include "tests/support/command.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>

#include "tests/support/fixtures.h"

namespace penumbra::tests {

std::string readFile(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

Result run(const std::string& arguments) {
    const std::string errors =
        temporaryFolder("command-errors-" + std::to_string(getpid())) + "/stderr";
    const std::string line = std::string(PENUMBRA_COMMAND) + " " + arguments + " 2>" + errors;
    Result result;
    std::FILE* pipe = popen(line.c_str(), "r");
    char text[4096];
    while (std::fgets(text, sizeof text, pipe)) result.output += text;
    const int status = pclose(pipe);
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    result.errors = readFile(errors);
    return result;
}

}  // namespace penumbra::tests
