// SPDX-License-Identifier: MIT
// One open device and its programs, for all that run passes by themselves.
#pragma once
#include <string>

#include "runtime/device.h"
#include "runtime/program.h"

namespace penumbra::tests {

/// The device under test: PENUMBRA_DEVICE, else the CPU. Opened once with profiling off.
runtime::Device& device();
/// A program of CMakeLists.txt, built once.
const runtime::Program& program(const std::string& name);

}  // namespace penumbra::tests
