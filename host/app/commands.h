// SPDX-License-Identifier: MIT
// One function per command: arguments are parsed already. Results go to stdout, all else to stderr.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/penumbra.h"

namespace penumbra::app {

struct RenderArguments {
    RenderOptions options;
    std::string output, frames = "0", stats;
    bool resume = false, quiet = false, verbose = false;
};

struct CompareArguments {
    RenderOptions options;
    std::vector<std::string> techniques;
    std::string reference = "raytrace", referenceSamples = "1024", frames = "0", report, sweep,
                command;
    int repeats = 3;
    bool json = false, quiet = false;
};

struct DiffArguments {
    std::string a, b, layer, mask;
    std::optional<double> failRmse, failMax, failPsnr, failSsim, failFlip;
    double pixelsPerDegree = 67;
    std::vector<std::string> failShares;  ///< "4=0.01"
    bool json = false;
};

int runRender(const RenderArguments& arguments);
int runCompare(const CompareArguments& arguments);
int runDiff(const DiffArguments& arguments);
int runDevices(const std::string& requested, bool json, bool verbose);
int runTechniques(bool json);
int runInfo(const std::string& scene, bool json);

}  // namespace penumbra::app
