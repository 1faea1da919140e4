// SPDX-License-Identifier: MIT
// The one table of drivers' peculiarities.
#pragma once
#include "runtime/device.h"

namespace penumbra::runtime {

/// Adjusts what a driver reports by the rows of the quirk table that match it.
void applyQuirks(DeviceInfo& info);

}  // namespace penumbra::runtime
