// SPDX-License-Identifier: MIT
// Lines of text as the arguments of the command; what follows a NUL is the --config file of render.
#include <algorithm>
#include <vector>

#include "host/app/cli.h"
#include "tests/fuzz/expect_one_line.h"

namespace {

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    for (std::size_t begin = 0; begin <= text.size();) {
        const auto end = std::min(text.find('\n', begin), text.size());
        lines.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return lines;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace penumbra;
    const auto* const end = std::find(bytes, bytes + size, 0);
    auto lines =
        linesOf({reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(end - bytes)});
    // Files of this machine are not the fuzzer's to read
    for (const auto& line : lines)
        if (line.rfind("--config", 0) == 0) return 0;
    const bool configured = end != bytes + size;
    const auto* const begin = configured ? end + 1 : end;
    const fuzz::MemoryFile config(begin, static_cast<std::size_t>(bytes + size - begin));
    if (configured) lines.insert(lines.end(), {"--config", config.path()});
    std::string name = "penumbra";
    std::vector<char*> arguments{name.data()};
    for (auto& line : lines) arguments.push_back(line.data());
    fuzz::expectOneLine(
        [&] { app::runCommandLine(static_cast<int>(arguments.size()), arguments.data()); });
    return 0;
}
