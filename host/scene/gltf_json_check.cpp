// SPDX-License-Identifier: MIT
// Walks the tokens of a JSON text once, with an explicit stack of the open objects and arrays.
// Values below `extras` and `extensions` belong to others and are only checked for their depth.
#include "host/scene/gltf_json_check.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "runtime/error.h"

namespace penumbra::scene {

namespace {

constexpr std::size_t kMaxDepth = 128;
constexpr std::string_view kSpace = " \t\r\n";

/// Kinds of values, as bits. Every `whole` number is a `number` too.
enum Kind : unsigned {
    kObject = 1,
    kArray = 2,
    kString = 4,
    kNumber = 8,
    kWhole = 16,
    kBoolean = 32,
    kNull = 64
};

/// What may stand under a name of glTF 2.0, and in an array there. A name has the same meaning
/// wherever it stands, or all its meanings are here.
struct Property {
    std::string_view name;
    unsigned value, element;
};

constexpr Property kProperties[] = {
    {"accessors", kArray, kObject},
    {"alphaCutoff", kNumber, 0},
    {"alphaMode", kString, 0},
    {"animations", kArray, kObject},
    {"aspectRatio", kNumber, 0},
    {"asset", kObject, 0},
    {"attributes", kObject, 0},
    {"baseColorFactor", kArray, kNumber},
    {"baseColorTexture", kObject, 0},
    {"buffer", kWhole, 0},
    {"bufferView", kWhole, 0},
    {"bufferViews", kArray, kObject},
    {"buffers", kArray, kObject},
    {"byteLength", kWhole, 0},
    {"byteOffset", kWhole, 0},
    {"byteStride", kWhole, 0},
    {"camera", kWhole, 0},
    {"cameras", kArray, kObject},
    {"channels", kArray, kObject},
    {"children", kArray, kWhole},
    {"componentType", kWhole, 0},
    {"count", kWhole, 0},
    {"doubleSided", kBoolean, 0},
    {"emissiveFactor", kArray, kNumber},
    {"emissiveTexture", kObject, 0},
    {"extensionsRequired", kArray, kString},
    {"extensionsUsed", kArray, kString},
    {"images", kArray, kObject},
    {"index", kWhole, 0},
    {"indices", kWhole | kObject, 0},
    {"input", kWhole, 0},
    {"interpolation", kString, 0},
    {"inverseBindMatrices", kWhole, 0},
    {"joints", kArray, kWhole},
    {"magFilter", kWhole, 0},
    {"material", kWhole, 0},
    {"materials", kArray, kObject},
    {"matrix", kArray, kNumber},
    {"mesh", kWhole, 0},
    {"meshes", kArray, kObject},
    {"metallicFactor", kNumber, 0},
    {"metallicRoughnessTexture", kObject, 0},
    {"mimeType", kString, 0},
    {"minVersion", kString, 0},
    {"mode", kWhole, 0},
    {"name", kString, 0},
    {"node", kWhole, 0},
    {"nodes", kArray, kWhole | kObject},
    {"normalTexture", kObject, 0},
    {"normalized", kBoolean, 0},
    {"orthographic", kObject, 0},
    {"output", kWhole, 0},
    {"path", kString, 0},
    {"pbrMetallicRoughness", kObject, 0},
    {"perspective", kObject, 0},
    {"primitives", kArray, kObject},
    {"rotation", kArray, kNumber},
    {"roughnessFactor", kNumber, 0},
    {"sampler", kWhole, 0},
    {"samplers", kArray, kObject},
    {"scale", kArray | kNumber, kNumber},
    {"scene", kWhole, 0},
    {"scenes", kArray, kObject},
    {"skeleton", kWhole, 0},
    {"skin", kWhole, 0},
    {"skins", kArray, kObject},
    {"source", kWhole, 0},
    {"sparse", kObject, 0},
    {"target", kWhole | kObject, 0},
    {"targets", kArray, kObject},
    {"texCoord", kWhole, 0},
    {"textures", kArray, kObject},
    {"translation", kArray, kNumber},
    {"type", kString, 0},
    {"uri", kString, 0},
    {"values", kObject, 0},
    {"version", kString, 0},
    {"weights", kArray, kNumber},
    {"wrapS", kWhole, 0},
    {"wrapT", kWhole, 0},
    {"xmag", kNumber, 0},
    {"yfov", kNumber, 0},
    {"ymag", kNumber, 0},
    {"zfar", kNumber, 0},
    {"znear", kNumber, 0},
};

std::string kindNames(unsigned kinds) {
    constexpr const char* kNames[] = {"an object",      "an array",  "a string", "a number",
                                      "a whole number", "a boolean", "null"};
    std::string names;
    for (unsigned i = 0; i < std::size(kNames); ++i)
        if (kinds >> i & 1U) names += (names.empty() ? "" : " or ") + std::string(kNames[i]);
    return names;
}

struct Open {
    bool isArray;
    bool exempt;           ///< inside of extras or extensions
    std::string_view key;  ///< under which the object or array stands
};

class JsonWalk {
  public:
    explicit JsonWalk(std::string_view text) : text_(text) {}

    std::size_t run() {
        const std::size_t first = text_.find_first_not_of(kSpace);
        require(first == std::string_view::npos || text_[first] != '[',
                "the JSON is an array; an object is needed");
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (c == '"') {
                readString();
            } else if (c == '{' || c == '[') {
                open(c == '[');
            } else if (c == '-' || (c >= '0' && c <= '9')) {
                readNumber();
            } else if (c >= 'a' && c <= 'z') {
                readWord();
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
        const std::size_t next = text_.find_first_not_of(kSpace, at_);
        const bool isName = next != std::string_view::npos && text_[next] == ':';
        if (!isName) checkKind(kString);
    }

    void readWord() {
        const std::size_t end =
            std::min(text_.find_first_not_of("abcdefghijklmnopqrstuvwxyz", at_), text_.size());
        const std::string_view word = text_.substr(at_, end - at_);
        at_ = end;
        if (word == "true" || word == "false") checkKind(kBoolean);
        if (word == "null") checkKind(kNull);
    }

    /// The name under which a value stands, itself or in an array.
    std::string_view keyOfValue() const { return stack_.back().isArray ? stack_.back().key : key_; }

    /// The kinds that may stand here; 0 where anything may.
    unsigned allowedHere() const {
        if (stack_.empty()) return 0;
        const Open& parent = stack_.back();
        if (parent.exempt) return 0;
        // Names of attributes are the file's own; all are of accessors
        if (!parent.isArray && (parent.key == "attributes" || parent.key == "targets"))
            return kWhole;
        const auto* const found =
            std::find_if(std::begin(kProperties), std::end(kProperties),
                         [&](const Property& p) { return p.name == keyOfValue(); });
        if (found == std::end(kProperties)) return 0;
        return parent.isArray ? found->element : found->value;
    }

    void checkKind(unsigned kind) const {
        const unsigned allowed = allowedHere();
        if (allowed == 0 || (allowed & kind) != 0) return;
        throw Error(fmt::format("the JSON has {} {} \"{}\"; {} is needed",
                                kindNames((kind & kNumber) != 0 ? kNumber : kind),
                                stack_.back().isArray ? "in" : "as", keyOfValue(),
                                kindNames(allowed)));
    }

    void takeKey() {
        key_ = lastString_;
        // Or else "\u0062uffers" would pass unseen; glTF 2.0 section 2.7.1 forbids such names
        require(stack_.size() != 1 || key_.find('\\') == std::string_view::npos,
                "the JSON has the property name \"{}\"; names must be written without escapes",
                key_);
    }

    void open(bool isArray) {
        checkKind(isArray ? kArray : kObject);
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
        const bool whole = number.find_first_not_of("0123456789") == std::string_view::npos;
        constexpr std::string_view kLargest = "2147483647";
        const bool small = number.size() < kLargest.size() ||
                           (number.size() == kLargest.size() && number <= kLargest);
        const unsigned allowed = allowedHere();
        require((allowed & kWhole) == 0 || (whole && small),
                "the JSON has \"{}\": {}; it must be a whole number from 0 to {}",
                stack_.empty() ? key_ : keyOfValue(), number, kLargest);
        checkKind(kNumber | kWhole);
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
