// SPDX-License-Identifier: MIT
// Makes small glTF files for the tests: arrays become views and accessors of one buffer.
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <type_traits>
#include <vector>

#include "host/scene/gltf_loader.h"
#include "runtime/error.h"

namespace penumbra::scene {

class GltfTestFile {
  public:
    /// Index of a new buffer view that holds the values.
    template <typename Number>
    int view(const std::vector<Number>& values, int stride = 0) {
        bin_.resize((bin_.size() + 3) / 4 * 4);
        const std::size_t offset = bin_.size(), size = values.size() * sizeof(Number);
        bin_.resize(offset + size);
        std::memcpy(bin_.data() + offset, values.data(), size);
        views_ += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}{}}})",
                              views_.empty() ? "" : ",", offset, size,
                              stride == 0 ? "" : fmt::format(R"(,"byteStride":{})", stride));
        return viewCount_++;
    }

    /// Index of a new accessor from its JSON text.
    int accessorText(const std::string& text) {
        accessors_ += (accessors_.empty() ? "" : ",") + text;
        return accessorCount_++;
    }

    /// Index of a new accessor over a new view; `extra` is further JSON, such as "normalized":true.
    template <typename Number>
    int accessor(const std::vector<Number>& values, const std::string& type,
                 const std::string& extra = "") {
        const std::size_t components = type == "SCALAR" ? 1
                                       : type == "MAT4" ? 16
                                                        : static_cast<std::size_t>(type[3] - '0');
        return accessorText(
            fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}{}}})",
                        view(values), componentType<Number>(), values.size() / components, type,
                        extra.empty() ? "" : ",", extra));
    }

    template <typename Number>
    static int componentType() {
        if (std::is_same_v<Number, std::int8_t>) return 5120;
        if (std::is_same_v<Number, std::uint8_t>) return 5121;
        if (std::is_same_v<Number, std::int16_t>) return 5122;
        if (std::is_same_v<Number, std::uint16_t>) return 5123;
        return std::is_same_v<Number, std::uint32_t> ? 5125 : 5126;
    }

    /// The file's JSON with `rest` for all that is not data; `uri` is that of the buffer.
    std::string json(const std::string& rest, const std::string& uri = "") const {
        const std::string uriText = uri.empty() ? "" : fmt::format(R"("uri":"{}",)", uri);
        std::string text = R"({"asset":{"version":"2.0"})";
        if (!bin_.empty())
            text += fmt::format(R"(,"buffers":[{{{}"byteLength":{}}}],"bufferViews":[{}])", uriText,
                                bin_.size(), views_);
        if (!accessors_.empty()) text += fmt::format(R"(,"accessors":[{}])", accessors_);
        return text + (rest.empty() ? "" : "," + rest) + "}";
    }

    std::string glb(const std::string& rest) const { return wrap(json(rest), bin_); }

    static std::string wrap(std::string jsonText, std::vector<std::uint8_t> bin) {
        jsonText.resize((jsonText.size() + 3) / 4 * 4, ' ');
        bin.resize((bin.size() + 3) / 4 * 4);
        std::string out = "glTF";
        const auto append = [&](std::size_t number) {
            for (int i = 0; i < 4; ++i) out += static_cast<char>(number >> (8 * i) & 0xFFU);
        };
        append(2);
        append(20 + jsonText.size() + (bin.empty() ? 0 : 8 + bin.size()));
        append(jsonText.size());
        out += "JSON" + jsonText;
        if (bin.empty()) return out;
        append(bin.size());
        out += std::string("BIN\0", 4) + std::string(bin.begin(), bin.end());
        return out;
    }

    Scene load(const std::string& rest) const {
        const std::string bytes = glb(rest);
        return loadGlb(bytes.data(), bytes.size(), "test.glb");
    }

    /// Loads a scene of one node with one mesh of one primitive, whose JSON members are given.
    Primitive loadPrimitive(const std::string& members) const {
        return load(meshOf(members)).meshes.at(0).primitives.at(0);
    }

    static std::string meshOf(const std::string& members) {
        return R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{)" + members + "}]}]";
    }

    const std::vector<std::uint8_t>& bin() const { return bin_; }

  private:
    std::vector<std::uint8_t> bin_;
    std::string views_, accessors_;
    int viewCount_ = 0, accessorCount_ = 0;
};

/// Nine floats: the right triangle (0,0,0), (1,0,0), (0,1,0), which faces +Z.
inline std::vector<float> rightTriangle() {
    return {0, 0, 0, 1, 0, 0, 0, 1, 0};
}

/// The message of the Error that the load throws; fails the test where it throws none.
template <typename Load>
std::string messageOf(const Load& load) {
    try {
        load();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::failed);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error.what();
    } catch (const std::exception& other) {
        ADD_FAILURE() << "not an Error: " << other.what();
        return {};
    }
    ADD_FAILURE() << "nothing was thrown";
    return {};
}

/// Passes if `text` contains `part`.
inline testing::AssertionResult contains(const std::string& text, const std::string& part) {
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "\"" << text << "\" does not contain \"" << part << "\"";
}

/// Passes if one of the scene's warnings contains `part`, and only one.
inline testing::AssertionResult warnsOnce(const Scene& scene, const std::string& part) {
    int found = 0;
    std::string all;
    for (const std::string& warning : scene.warnings) {
        found += warning.find(part) != std::string::npos ? 1 : 0;
        all += "\n  " + warning;
    }
    if (found == 1) return testing::AssertionSuccess();
    return testing::AssertionFailure() << found << " warnings contain \"" << part << "\":" << all;
}

/// A folder of its own for each test, removed afterwards.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "penumbraXXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    /// Writes the file, its folders too, and returns its path.
    template <typename Bytes>
    std::string write(const std::string& name, const Bytes& bytes) const {
        std::filesystem::create_directories((path_ / name).parent_path());
        std::ofstream(path_ / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()),
                   static_cast<std::streamsize>(bytes.size()));
        return (path_ / name).string();
    }
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace penumbra::scene
