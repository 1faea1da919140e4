// SPDX-License-Identifier: MIT
// What a failed call of OpenCL means to the user.
#pragma once
#include <string>

#include "runtime/device.h"
#include "runtime/error.h"

namespace penumbra::runtime {

/// Megabytes in use, allowed, and allowed at once, for messages.
std::string memoryFigures(const Device& device);

/// The error for a call that failed with an OpenCL code: out of memory (exit code 4, with the
/// figures), a device that is gone (exit code 3), or anything else (1). `call` as "upload of 'x'".
Error callError(const Device& device, const std::string& call, int code);

/// The error for a device that stopped answering.
Error lostError(const Device& device, const std::string& call, int code);

}  // namespace penumbra::runtime
