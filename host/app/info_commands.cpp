// SPDX-License-Identifier: MIT
// info, devices, techniques: the library's JSON as it is, or as text.
#include <nlohmann/json.hpp>

#include "host/app/commands.h"
#include "runtime/error.h"

namespace penumbra::app {
namespace {

using nlohmann::json;

std::string plain(const json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return fmt::format("{:.6g}", value.get<double>());
    return value.dump();
}

/// "name value, name value" of an object's members, short enough for a line.
std::string inLine(const json& object) {
    std::string line;
    for (const auto& [key, value] : object.items()) {
        std::string text = plain(value);
        if (value.is_array()) {
            text.clear();
            for (const auto& element : value) text += (text.empty() ? "" : " ") + plain(element);
        }
        line += fmt::format("{}{} {}", line.empty() ? "" : ", ", key, text.empty() ? "-" : text);
    }
    return line;
}

std::string rangeOf(const json& row) {
    if (row["kind"] == "enum")
        return fmt::format("{}", fmt::join(row["choices"].get<std::vector<std::string>>(), "|"));
    if (row["kind"] == "bool") return "true|false";
    return fmt::format("{} to {} {}", plain(row["lowest"]), plain(row["highest"]),
                       plain(row["unit"]));
}

}  // namespace

int runDevices(const std::string& requested, bool asJson, bool verbose) {
    const std::string text = devicesJson(requested);
    const auto result = json::parse(text);
    const bool none = result["devices"].empty();
    if (asJson) {
        fmt::print("{}\n", text);
        return static_cast<int>(none ? ExitCode::noDevice : ExitCode::done);
    }
    if (none) throw Error(plain(result["why"]), ExitCode::noDevice);
    for (const auto& d : result["devices"]) {
        fmt::print("{} {}: {} / {} ({}, {} compute units{}){}\n",
                   d["chosen"].get<bool>() ? "*" : " ", d["index"].get<int>(), plain(d["platform"]),
                   plain(d["name"]), plain(d["kind"]), d["computeUnits"].get<int>(),
                   d["usable"].get<bool>() ? "" : ", not usable",
                   plain(d["note"]).empty() ? "" : ": " + plain(d["note"]));
        if (verbose) fmt::print("     {}\n", inLine(d));
    }
    fmt::print("* is chosen: {}\n", plain(result["why"]));
    return 0;
}

int runTechniques(bool asJson) {
    const std::string text = techniquesJson();
    if (asJson) {
        fmt::print("{}\n", text);
        return 0;
    }
    const auto parsed = json::parse(text);
    for (const auto& t : parsed["techniques"]) {
        fmt::print("{}: {} {}\n  fails: {}\n", plain(t["name"]), plain(t["summary"]),
                   plain(t["source"]), plain(t["failures"]));
        for (const auto& row : t["settings"])
            fmt::print("  --set {}.{}={}  [{}]  {}\n", plain(t["name"]), plain(row["name"]),
                       plain(row["default"]), rangeOf(row), plain(row["meaning"]));
    }
    return 0;
}

int runInfo(const std::string& scene, bool asJson) {
    const std::string text = infoJson(scene);
    if (asJson) {
        fmt::print("{}\n", text);
        return 0;
    }
    const auto info = json::parse(text);
    fmt::print("{}: {} nodes, {} triangles drawn\n", plain(info["scene"]), plain(info["nodes"]),
               plain(info["trianglesDrawn"]));
    for (const char* list :
         {"meshes", "materials", "images", "skins", "animations", "cameras", "lights"}) {
        fmt::print("{}: {}\n", list, info[list].size());
        for (const auto& entry : info[list])
            fmt::print("  {}\n", entry.is_object() ? inLine(entry) : plain(entry));
    }
    fmt::print("bounds: {}\n", inLine(info["bounds"]));
    for (const auto& warning : info["warnings"])
        fmt::print("ignored or replaced: {}\n", plain(warning));
    return 0;
}

}  // namespace penumbra::app
