// SPDX-License-Identifier: MIT
#include "runtime/one_line.h"

#include <algorithm>

namespace penumbra {

std::string toOneLine(const std::string& text) {
    constexpr std::size_t kLongest = 400;
    std::string line = text.substr(0, kLongest);
    std::replace_if(
        line.begin(), line.end(),
        [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }, ' ');
    while (!line.empty() && line.back() == ' ') line.pop_back();
    return text.size() > kLongest ? line + "..." : line;
}

}  // namespace penumbra
