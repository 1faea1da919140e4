// SPDX-License-Identifier: MIT
#pragma once
#include "host/penumbra.h"

namespace penumbra::fuzz {

/// Parses settings, lights and light samples as a render does before it opens a device.
void checkOptions(const RenderOptions& options);

}  // namespace penumbra::fuzz
