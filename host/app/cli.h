// SPDX-License-Identifier: MIT
#pragma once

namespace penumbra::app {

/// Parses the command line, runs the command and returns its exit code. Errors are thrown.
int runCommandLine(int argc, char** argv);

}  // namespace penumbra::app
