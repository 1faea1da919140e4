// SPDX-License-Identifier: MIT
// Text of a configuration file -> the arguments of render, through options of each kind.
#include "host/app/config_file.h"
#include "tests/fuzz/expect_one_line.h"

namespace {

/// Making a command with all its options takes longer than reading a file.
const CLI::App& command() {
    static CLI::App render;
    static std::string text;
    static std::vector<std::string> texts, list;
    static std::vector<double> numbers;
    static bool flag;
    static const bool made = [] {
        render.add_option("--size,-s", text);
        render.add_option("--set", texts)->allow_extra_args(false);
        render.add_option("--aov", list)->allow_extra_args(false)->delimiter(',');
        render.add_option("--eye", numbers)->delimiter(',')->expected(3);
        render.add_flag("--ground", flag);
        return true;
    }();
    static_cast<void>(made);
    return render;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    using namespace penumbra;
    const fuzz::MemoryFile file(bytes, size);
    fuzz::expectOneLine([&] {
        app::withConfig({"render", "--config", file.path(), "--size=1x1", "--set", "a.b=c"},
                        command());
    });
    return 0;
}
