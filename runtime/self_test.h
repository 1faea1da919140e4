// SPDX-License-Identifier: MIT
#pragma once
#include "runtime/program.h"

namespace penumbra::runtime {

/// Runs a kernel whose answers are known. Throws Error (exit code 3) naming what the device gets
/// wrong.
void selfTest(const Program& frame);

}  // namespace penumbra::runtime
