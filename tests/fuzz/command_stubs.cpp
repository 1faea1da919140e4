// SPDX-License-Identifier: MIT
// The commands as the target of whole command lines links them: arguments are checked as the real
// ones do, and nothing is opened or rendered.
#include "host/app/commands.h"
#include "host/app/frame_list.h"
#include "tests/fuzz/check_options.h"

namespace penumbra {

const char* version() {
    return "fuzz";
}

namespace app {

int runRender(const RenderArguments& arguments) {
    parseFrames(arguments.frames, 100);
    framePath(arguments.output, 7);
    fuzz::checkOptions(arguments.options);
    return 0;
}

int runCompare(const CompareArguments& arguments) {
    parseFrames(arguments.frames, 100);
    fuzz::checkOptions(arguments.options);
    return 0;
}

int runDiff(const DiffArguments&) {
    return 0;
}
int runDevices(const std::string&, bool, bool) {
    return 0;
}
int runTechniques(bool) {
    return 0;
}
int runInfo(const std::string&, bool) {
    return 0;
}

}  // namespace app
}  // namespace penumbra
