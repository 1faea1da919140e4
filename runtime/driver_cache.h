// SPDX-License-Identifier: MIT
// The folder where PoCL keeps compiled kernels: without one it offers no device at all.
#pragma once
#include <string>

namespace penumbra::runtime {

/// Call before the first call of OpenCL. Where PoCL's folder cannot be written, or has no room
/// left, gives it a folder for this process alone. Returns what was wrong; empty if nothing.
const std::string& prepareDriverCache();

/// PoCL's folder; empty if nothing in the environment tells.
std::string driverCacheFolder();

}  // namespace penumbra::runtime
