// SPDX-License-Identifier: MIT
// Pictures of make_scene as PNG files, uncompressed: the same bytes everywhere.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tools {

struct Picture {
    uint32_t width, height;
    std::vector<std::array<uint8_t, 4>> texels;  // RGBA, rows from the top

    Picture(uint32_t w, uint32_t h) : width(w), height(h), texels(std::size_t{w} * h) {}
    std::array<uint8_t, 4>& at(uint32_t column, uint32_t row) {
        return texels[std::size_t{row} * width + column];
    }
};

std::vector<uint8_t> toPng(const Picture& picture);

}  // namespace tools
