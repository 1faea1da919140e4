// SPDX-License-Identifier: MIT
#include "host/app/frame_list.h"

#include <algorithm>
#include <charconv>

#include "runtime/error.h"

namespace penumbra::app {
namespace {

constexpr int kMaxFrame = 1000000;

int parseFrame(const std::string& text, const std::string& whole) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    requireUsage(
        error == std::errc() && end == text.data() + text.size() && value >= 0 &&
            value <= kMaxFrame,
        "--frames '{}': '{}' is not a frame; allowed: 1,3,5..10 or 0..119 or all, frames 0 to {}",
        whole, text, kMaxFrame);
    return value;
}

std::vector<int> listOf(const std::vector<bool>& wanted) {
    std::vector<int> frames;
    for (std::size_t f = 0; f < wanted.size(); ++f)
        if (wanted[f]) frames.push_back(static_cast<int>(f));
    return frames;
}

}  // namespace

std::vector<int> parseFrames(const std::string& text, int frameCount) {
    std::vector<bool> wanted;
    if (text == "all") {
        requireUsage(frameCount <= kMaxFrame + 1,
                     "--frames all are more than {} frames; name some, as 0..119 does", kMaxFrame);
        wanted.assign(static_cast<std::size_t>(std::max(frameCount, 0)), true);
        return listOf(wanted);
    }
    std::size_t begin = 0;
    while (begin <= text.size()) {
        const auto end = std::min(text.find(',', begin), text.size());
        const std::string item = text.substr(begin, end - begin);
        const auto dots = item.find("..");
        const int first = parseFrame(item.substr(0, dots), text);
        const int last =
            dots == std::string::npos ? first : parseFrame(item.substr(dots + 2), text);
        requireUsage(first <= last, "--frames '{}': {}..{} runs backwards", text, first, last);
        wanted.resize(std::max(wanted.size(), static_cast<std::size_t>(last) + 1));
        std::fill(wanted.begin() + first, wanted.begin() + last + 1, true);
        begin = end + 1;
    }
    return listOf(wanted);
}

bool hasFrameNumber(const std::string& pattern) {
    return pattern.find('#') != std::string::npos;
}

std::string framePath(const std::string& pattern, int frame) {
    const auto last = pattern.find_last_of('#');
    if (last == std::string::npos) return pattern;
    auto first = last;
    while (first > 0 && pattern[first - 1] == '#') --first;
    return fmt::format("{}{:0{}}{}", pattern.substr(0, first), frame, last - first + 1,
                       pattern.substr(last + 1));
}

}  // namespace penumbra::app
