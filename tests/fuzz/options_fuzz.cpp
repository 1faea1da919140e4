// SPDX-License-Identifier: MIT
// The parsers of values of options: the first byte says which, the rest is the text.
#include <array>

#include "host/app/frame_list.h"
#include "tests/fuzz/check_options.h"
#include "tests/fuzz/expect_one_line.h"

namespace penumbra::fuzz {
namespace {

void parseAs(std::uint8_t kind, const std::string& text) {
    RenderOptions options;
    switch (kind % 5) {
        case 0:
            for (const int frame : app::parseFrames(text, 100)) expect(frame >= 0, "frames from 0");
            return;
        case 1:
            options.lights = {text};
            break;
        case 2:
            options.lightSamples = text.substr(0, text.find(' '));
            options.lightPattern = text.find(' ') == std::string::npos
                                       ? options.lightPattern
                                       : text.substr(text.find(' ') + 1);
            break;
        case 3:
            options.seed = text;
            break;
        default:
            options.settings[text.substr(0, text.find('='))] =
                text.find('=') == std::string::npos ? "" : text.substr(text.find('=') + 1);
    }
    checkOptions(options);
}

}  // namespace
}  // namespace penumbra::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    if (size == 0) return 0;
    const std::string text(reinterpret_cast<const char*>(bytes) + 1, size - 1);
    // The text is part of the message, and a shell passes it on as it is
    if (text.find('\n') != std::string::npos) return 0;
    penumbra::fuzz::expectOneLine([&] { penumbra::fuzz::parseAs(bytes[0], text); });
    return 0;
}
