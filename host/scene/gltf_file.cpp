// SPDX-License-Identifier: MIT
// tinygltf 2.7 is guarded here: it reads up to 8 bytes past a .glb whose BIN chunk claims too much,
// decodes images without a range check, follows "../" and looks for files in the working folder.
// So: the container and the JSON are checked first, images are only kept, files go through
// callbacks.
#include "host/scene/gltf_file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>

#include "host/scene/gltf_context.h"
#include "host/scene/gltf_json_check.h"

namespace penumbra::scene {

namespace fs = std::filesystem;

namespace {

struct Container {
    std::string_view json;
    std::uint64_t binBytes = 0;
    bool isGlb = false;
};

std::uint32_t readLittleEndian(const unsigned char* bytes) {
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8U |
           static_cast<std::uint32_t>(bytes[2]) << 16U |
           static_cast<std::uint32_t>(bytes[3]) << 24U;
}

/// Header of 12 bytes, then chunks: length, type, bytes. The first is JSON, a second BIN.
Container checkContainer(const unsigned char* bytes, std::size_t size) {
    if (size < 4 || std::memcmp(bytes, "glTF", 4) != 0)
        return {{reinterpret_cast<const char*>(bytes), size}, 0, false};
    require(size >= 20, "is a .glb of {} bytes; its headers alone take 20", size);
    const std::uint32_t version = readLittleEndian(bytes + 4);
    require(version == 2, "is a .glb of version {}; only version 2 is supported", version);
    const std::uint64_t length = readLittleEndian(bytes + 8);
    require(length <= size, "is a .glb that claims {} bytes but has {}", length, size);
    const std::uint64_t jsonBytes = readLittleEndian(bytes + 12);
    require(jsonBytes >= 1 && 20 + jsonBytes <= length,
            "is a .glb with a JSON chunk of {} bytes in a file of {}", jsonBytes, length);
    Container container{{reinterpret_cast<const char*>(bytes + 20), jsonBytes}, 0, true};
    if (20 + jsonBytes == length) return container;
    require(28 + jsonBytes <= length, "is a .glb that ends inside of the header of its BIN chunk");
    container.binBytes = readLittleEndian(bytes + 20 + jsonBytes);
    require(28 + jsonBytes + container.binBytes <= length,
            "is a .glb with a BIN chunk of {} bytes, of which {} are there", container.binBytes,
            length - 28 - jsonBytes);
    return container;
}

/// The path of an external file, empty if it is absent; throws for what must not be read.
fs::path resolve(const ExternalFiles& files, std::string name) {
    if (name.rfind("./", 0) == 0) name.erase(0, 2);              // tinygltf's second try
    if (name.rfind("data:", 0) == 0 || name.empty()) return {};  // a media type tinygltf ignores
    require(files.allowed, "refers to the file '{}', but a scene in memory must hold all its data",
            toOneLine(name));
    bool leaves = name.find('\0') != std::string::npos || name.front() == '/' ||
                  name.front() == '\\' || name.find(':') < name.find('/');
    std::string part;
    for (std::istringstream parts(name); std::getline(parts, part, '/');)
        leaves = leaves || part == ".." || part.rfind("..\\", 0) == 0 ||
                 part.find("\\..") != std::string::npos;
    const char* const rule =
        "refers to the file '{}'; only relative paths to regular files inside "
        "of the scene's folder are read";
    require(!leaves, fmt::runtime(rule), toOneLine(name));
    std::error_code error;
    fs::path path = fs::weakly_canonical(files.folder / name, error);
    if (!error && !fs::exists(path, error)) {
        // tinygltf decodes '+' as a space, which is right in forms but not in paths
        std::replace(name.begin(), name.end(), ' ', '+');
        path = fs::weakly_canonical(files.folder / name, error);
    }
    if (error) return {};
    const fs::path relative = path.lexically_relative(files.folder);
    require(!relative.empty() && *relative.begin() != "..", fmt::runtime(rule), toOneLine(name));
    if (!fs::exists(path, error)) return {};
    require(fs::is_regular_file(path, error), fmt::runtime(rule), toOneLine(name));
    return path;
}

bool fileExists(const std::string& name, void* files) {
    return !resolve(*static_cast<ExternalFiles*>(files), name).empty();
}

std::string keepPath(const std::string& name, void*) {
    return name;
}

bool readWholeFile(std::vector<unsigned char>* out, std::string*, const std::string& name,
                   void* user) {
    auto& files = *static_cast<ExternalFiles*>(user);
    *out = readFile(resolve(files, name));
    require(out->size() <= files.bytesLeft, "refers to more than {} GiB of external files",
            kMaxExternalBytes >> 30U);
    files.bytesLeft -= out->size();
    return true;
}

/// Images in buffer views are found again by their view, once that has been checked.
bool keepImageBytes(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
                    const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
    return true;
}

/// tinygltf drops what it could not parse and still reports success; only these lines are harmless.
void reviewComplaints(const std::string& complaints, std::vector<std::string>& warnings) {
    std::istringstream lines(complaints);
    for (std::string line; std::getline(lines, line);) {
        if (line.empty() || line.find("'inverseBindMatrices' property is missing") == 0) continue;
        if (line.find("'node' property is missing") == 0) continue;
        require(line.find("`node` field is missing in animation") == 0 ||
                    line.find("JSON Chunk end does not aligned") == 0,
                "is not valid: {}", toOneLine(line));
        warnings.push_back(line[0] == 'J' ? "the JSON chunk is not padded to 4 bytes"
                                          : "animation channels without a node are ignored");
    }
}

}  // namespace

std::vector<unsigned char> readFile(const fs::path& path) {
    std::error_code error;
    require(fs::exists(path, error), "'{}' does not exist", path.string());
    require(fs::is_regular_file(path, error), "'{}' is not a regular file", path.string());
    const std::uint64_t size = fs::file_size(path, error);
    require(!error, "'{}' cannot be read: {}", path.string(), error.message());
    require(size > 0 && size <= kMaxFileBytes, "'{}' has {} bytes; allowed are 1 to {}",
            path.string(), size, kMaxFileBytes);
    std::vector<unsigned char> bytes(size);
    std::ifstream stream(path, std::ios::binary);
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    require(stream.good(), "'{}' cannot be read", path.string());
    return bytes;
}

tinygltf::Model parseGltf(const unsigned char* bytes, std::size_t size, ExternalFiles& files,
                          std::vector<std::string>& warnings) {
    require(size > 0 && size <= kMaxFileBytes, "has {} bytes; allowed are 1 to {}", size,
            kMaxFileBytes);
    const Container container = checkContainer(bytes, size);
    const std::uint64_t bufferCount = checkJson(container.json);
    // Every buffer without a URI would get its own copy of the BIN chunk
    require(bufferCount * container.binBytes <= kMaxExternalBytes,
            "has {} buffers beside a BIN chunk of {} bytes; one of them may use it", bufferCount,
            container.binBytes);
    tinygltf::TinyGLTF parser;
    parser.SetImageLoader(keepImageBytes, nullptr);
    parser.SetFsCallbacks({fileExists, keepPath, readWholeFile, nullptr, &files});
    tinygltf::Model model;
    std::string complaints, remarks;
    const bool parsed = container.isGlb
                            ? parser.LoadBinaryFromMemory(&model, &complaints, &remarks, bytes,
                                                          static_cast<unsigned int>(size), "")
                            : parser.LoadASCIIFromString(&model, &complaints, &remarks,
                                                         reinterpret_cast<const char*>(bytes),
                                                         static_cast<unsigned int>(size), "");
    require(parsed, "is not valid: {}",
            complaints.empty() ? "tinygltf gave no reason" : toOneLine(complaints));
    reviewComplaints(complaints, warnings);
    require(model.asset.version.rfind("2.", 0) == 0 &&
                (model.asset.minVersion.empty() || model.asset.minVersion == "2.0"),
            "is glTF {}{}{}; only 2.0 is supported", toOneLine(model.asset.version),
            model.asset.minVersion.empty() ? "" : " and needs ", toOneLine(model.asset.minVersion));
    return model;
}

}  // namespace penumbra::scene
