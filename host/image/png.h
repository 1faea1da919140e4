// SPDX-License-Identifier: MIT
// PNG files in memory.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace penumbra::image {

/// 8-bit RGBA, rows from the top; 16-bit files lose their low bytes.
struct PngPixels {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
    std::vector<std::pair<std::string, std::string>> header;  ///< text chunks
};

/// Throws Error with libpng's reason. Memory and time are bounded by the size that the file's
/// header tells, whatever its compressed data would inflate to.
PngPixels decodePng(const unsigned char* bytes, std::size_t size);

}  // namespace penumbra::image
