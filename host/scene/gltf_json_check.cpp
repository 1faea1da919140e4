// SPDX-License-Identifier: MIT
// Walks the tokens of a JSON text once, with an explicit stack of the open objects and arrays.
// Values below `extras` and `extensions` belong to others and are only checked for their depth.
#include "host/scene/gltf_json_check.h"

#include <algorithm>
#include <array>
#include <vector>

#include "runtime/error.h"

namespace penumbra::scene {

namespace {

constexpr std::size_t kMaxDepth = 128;

constexpr std::array<std::string_view, 26> kWholeNumbers = {
    "buffer",   "bufferView",   "byteLength", "byteOffset", "byteStride", "camera",
    "children", "count",        "index",      "indices",    "input",      "inverseBindMatrices",
    "joints",   "material",     "mesh",       "mode",       "node",       "nodes",
    "output",   "sampler",      "scene",      "skeleton",   "skin",       "source",
    "texCoord", "componentType"};

struct Open {
    bool isArray;
    bool exempt;           ///< inside of extras or extensions
    std::string_view key;  ///< under which the object or array stands
};

class JsonWalk {
  public:
    explicit JsonWalk(std::string_view text) : text_(text) {}

    std::size_t run() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"') {
                readString();
            } else if (c == '{' || c == '[') {
                open(c == '[');
            } else if (c == '-' || (c >= '0' && c <= '9')) {
                readNumber();
            } else {
                if (c == ':') takeKey();
                if ((c == '}' || c == ']') && !stack_.empty()) stack_.pop_back();
                ++at_;
            }
        }
        return bufferCount_;
    }

  private:
    void readString() {
        const std::size_t begin = ++at_;
        while (at_ < text_.size() && text_[at_] != '"') at_ += text_[at_] == '\\' ? 2 : 1;
        at_ = std::min(at_, text_.size());
        lastString_ = text_.substr(begin, at_ - begin);
        ++at_;
    }

    void takeKey() {
        key_ = lastString_;
        // Or else "\u0062uffers" would pass unseen; glTF 2.0 section 2.7.1 forbids such names
        require(stack_.size() != 1 || key_.find('\\') == std::string_view::npos,
                "the JSON has the property name \"{}\"; names must be written without escapes",
                key_);
    }

    void open(bool isArray) {
        require(stack_.size() < kMaxDepth, "the JSON nests deeper than {} levels", kMaxDepth);
        const bool inArray = !stack_.empty() && stack_.back().isArray;
        const std::string_view key = inArray ? stack_.back().key : key_;
        const bool exempt =
            (!stack_.empty() && stack_.back().exempt) || key == "extras" || key == "extensions";
        if (!isArray && inArray && stack_.size() == 2 && key == "buffers") ++bufferCount_;
        stack_.push_back({isArray, exempt, key});
        key_ = {};
        ++at_;
    }

    void readNumber() {
        const std::size_t end =
            std::min(text_.find_first_not_of("0123456789+-.eE", at_), text_.size());
        const std::string_view number = text_.substr(at_, end - at_);
        at_ = end;
        if (stack_.empty() || stack_.back().exempt) return;
        const std::string_view key = stack_.back().isArray ? stack_.back().key : key_;
        if (std::find(kWholeNumbers.begin(), kWholeNumbers.end(), key) == kWholeNumbers.end())
            return;
        const bool whole = number.find_first_not_of("0123456789") == std::string_view::npos;
        constexpr std::string_view kLargest = "2147483647";
        const bool small = number.size() < kLargest.size() ||
                           (number.size() == kLargest.size() && number <= kLargest);
        require(whole && small, "the JSON has \"{}\": {}; it must be a whole number from 0 to {}",
                key, number, kLargest);
    }

    std::string_view text_;
    std::size_t at_ = 0;
    std::string_view lastString_, key_;
    std::vector<Open> stack_;
    std::size_t bufferCount_ = 0;
};

}  // namespace

std::size_t checkJson(std::string_view text) {
    return JsonWalk(text).run();
}

}  // namespace penumbra::scene
