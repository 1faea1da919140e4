// SPDX-License-Identifier: MIT
// penumbra_papers TABLE [--json FILE] [--report FOLDER] [--frames N] [--size WxH] [--device NAME]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "bench/papers/papers.h"
#include "runtime/error.h"

namespace {

int run(int argc, char** argv) {
    using namespace penumbra;
    CLI::App app("The papers' tables, measured on this device");
    std::string table, jsonFile, size = "1280x720", names;
    papers::Request request;
    for (const auto& t : papers::tables()) names += fmt::format("\n  {:<12} {}", t.name, t.what);
    app.footer("Tables:" + names);
    app.add_option("TABLE", table, "which one")->required();
    app.add_option("--json", jsonFile, "write rows and device as JSON");
    app.add_option("--report", request.report, "folder of pages, one for each scene");
    app.add_option("--frames", request.frames, "frames of a second of animation")
        ->check(CLI::Range(1, 24))
        ->capture_default_str();
    app.add_option("--size", size, "pixels")->capture_default_str();
    app.add_option("--device", request.device, "as for penumbra render");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        throw Error(std::string(error.what()) + "; see --help", ExitCode::usage);
    }
    requireUsage(std::sscanf(size.c_str(), "%dx%d", &request.width, &request.height) == 2,
                 "--size '{}' is not WIDTHxHEIGHT", size);
    for (const auto& t : papers::tables()) {
        if (table != t.name) continue;
        const auto rows = t.run(request);
        const bool missed = std::any_of(rows.begin(), rows.end(), [](const auto& row) {
            return row.is_object() && row.value("verdict", "") == "missed";
        });
        if (jsonFile.empty()) return missed ? 1 : 0;
        std::ofstream file(jsonFile);
        file << nlohmann::json({{"table", table},
                                {"version", version()},
                                {"devices", nlohmann::json::parse(devicesJson(request.device))},
                                {"rows", rows}})
                    .dump(2)
             << '\n';
        require(static_cast<bool>(file.flush()), "--json {}: cannot be written", jsonFile);
        return missed ? 1 : 0;
    }
    throw Error(fmt::format("table '{}' is unknown; allowed:{}", table, names), ExitCode::usage);
}

}  // namespace

int main(int argc, char** argv) try {
    return run(argc, argv);
} catch (const std::exception& error) {
    std::fprintf(stderr, "penumbra_papers: %s\n", error.what());
    return penumbra::exitCodeOf(error);
}
