// SPDX-License-Identifier: MIT
// What the tests share: one open device, programs built once, scenes made in code.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "host/penumbra.h"
#include "tests/support/opened_device.h"
#include "tests/support/scene_builder.h"

namespace penumbra::tests {

/// Folder of the real models: $PENUMBRA_ASSETS, else ../shared/assets beside the checkout; empty if
/// absent.
std::string assetFolder();
/// Path of a model such as "Fox/Fox.glb"; skips the test with a message where it is absent.
#define ASSET_OR_SKIP(variable, name)                                       \
    const std::string variable = penumbra::tests::assetFolder() + "/" name; \
    if (penumbra::tests::assetFolder().empty())                             \
    GTEST_SKIP() << "the models are absent; set PENUMBRA_ASSETS to their folder"

/// A folder for files of this test, emptied before.
std::string temporaryFolder(const std::string& name);

}  // namespace penumbra::tests
