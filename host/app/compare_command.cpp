// SPDX-License-Identifier: MIT
#include <cstdio>

#include "host/app/commands.h"
#include "host/app/frame_list.h"
#include "host/report/comparison.h"
#include "runtime/error.h"
#include "runtime/slow_notice.h"

namespace penumbra::app {
namespace {

bool quiet = false;

void printProgress(const std::string& line) {
    if (!quiet) fmt::print(stderr, "{}\n", line);
}

}  // namespace

int runCompare(const CompareArguments& arguments) {
    quiet = arguments.quiet;
    if (quiet) runtime::SlowNotice::silence();
    report::CompareOptions options;
    options.base = arguments.options;
    options.techniques = arguments.techniques;
    options.reference = arguments.reference;
    options.referenceSamples = arguments.referenceSamples;
    requireUsage(
        arguments.frames != "all",
        "--frames all: each technique would render the whole clip; name the frames, as 0..47 does");
    options.frames = parseFrames(arguments.frames, 0);
    options.repeats = arguments.repeats;
    options.sweep = arguments.sweep;
    options.command = arguments.command;
    options.folder = arguments.report;
    const auto comparison = report::compare(options, printProgress);
    for (const auto& warning : comparison.warnings)
        if (!quiet) fmt::print(stderr, "penumbra: warning: {}\n", warning);
    report::writeReport(comparison);
    if (arguments.json) {
        fmt::print("{}", report::resultsJson(comparison));
        return 0;
    }
    fmt::print("{:<24} {:>10} {:>9} {:>8} {:>8} {:>7}\n", "technique", "shadows ms", "x mvr",
               "RMSE", "FLIP", "max");
    for (const auto& r : comparison.results)
        fmt::print("{:<24} {:>10.2f} {:>9} {:>8.4f} {:>8.4f} {:>7.3f}\n", r.contender.label, r.ms,
                   r.fasterThanMvr ? fmt::format("{:.2f}", *r.fasterThanMvr) : "-", r.error.rmse,
                   r.error.flip, r.error.maximum);
    fmt::print("The report is {}/index.html\n", options.folder);
    return 0;
}

}  // namespace penumbra::app
