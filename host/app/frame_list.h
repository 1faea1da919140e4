// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

namespace penumbra::app {

/// "1,3,5..10", "0..119", "all" (0 to frameCount - 1), as Blender; ascending, each once. Throws
/// Error (usage).
std::vector<int> parseFrames(const std::string& text, int frameCount);

/// The output path of a frame: the last run of # becomes the number, padded with zeros.
std::string framePath(const std::string& pattern, int frame);
/// True if the pattern has a #.
bool hasFrameNumber(const std::string& pattern);

}  // namespace penumbra::app
