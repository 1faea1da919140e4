// SPDX-License-Identifier: MIT
#include "host/app/frame_list.h"

#include <algorithm>
#include <charconv>
#include <set>

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

}  // namespace

std::vector<int> parseFrames(const std::string& text, int frameCount) {
    std::set<int> frames;
    if (text == "all") {
        for (int f = 0; f < frameCount; ++f) frames.insert(f);
        return {frames.begin(), frames.end()};
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
        for (int f = first; f <= last; ++f) frames.insert(f);
        begin = end + 1;
    }
    return {frames.begin(), frames.end()};
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
