// SPDX-License-Identifier: MIT
// PNG 1.2 with stored deflate blocks (RFC 1950, 1951).
#include "make_scene_png.h"

#include <algorithm>
#include <string_view>

namespace tools {

namespace {

void put32(std::vector<uint8_t>& bytes, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        bytes.push_back(static_cast<uint8_t>((value >> shift) & 0xFFU));
}

uint32_t crc32(const uint8_t* data, size_t size) {
    uint32_t crc = 0xFFFFFFFFU;
    for (size_t i = 0; i < size; ++i) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ (crc & 1U ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

void putChunk(std::vector<uint8_t>& bytes, std::string_view type,
              const std::vector<uint8_t>& data) {
    put32(bytes, static_cast<uint32_t>(data.size()));
    const size_t start = bytes.size();
    bytes.insert(bytes.end(), type.begin(), type.end());
    bytes.insert(bytes.end(), data.begin(), data.end());
    put32(bytes, crc32(bytes.data() + start, bytes.size() - start));
}

std::vector<uint8_t> storedDeflate(const std::vector<uint8_t>& data) {
    constexpr size_t kBlock = 65535;
    std::vector<uint8_t> out = {0x78, 0x01};
    for (size_t at = 0; at < data.size(); at += kBlock) {
        const size_t size = std::min(kBlock, data.size() - at);
        out.push_back(at + size == data.size() ? 1 : 0);
        for (const size_t word : {size, ~size}) {
            out.push_back(static_cast<uint8_t>(word & 0xFFU));
            out.push_back(static_cast<uint8_t>((word >> 8U) & 0xFFU));
        }
        out.insert(out.end(), data.begin() + static_cast<std::ptrdiff_t>(at),
                   data.begin() + static_cast<std::ptrdiff_t>(at + size));
    }
    uint32_t a = 1;
    uint32_t b = 0;
    for (const uint8_t byte : data) {
        a = (a + byte) % 65521;
        b = (b + a) % 65521;
    }
    put32(out, b << 16U | a);
    return out;
}

}  // namespace

std::vector<uint8_t> toPng(const Picture& picture) {
    std::vector<uint8_t> rows;
    for (uint32_t row = 0; row < picture.height; ++row) {
        rows.push_back(0);  // no filter
        for (uint32_t column = 0; column < picture.width; ++column)
            for (const uint8_t value : picture.texels[std::size_t{row} * picture.width + column])
                rows.push_back(value);
    }
    std::vector<uint8_t> header;
    put32(header, picture.width);
    put32(header, picture.height);
    for (const uint8_t value : {8, 6, 0, 0, 0}) header.push_back(value);  // RGBA, 8 bits
    std::vector<uint8_t> bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    putChunk(bytes, "IHDR", header);
    putChunk(bytes, "IDAT", storedDeflate(rows));
    putChunk(bytes, "IEND", {});
    return bytes;
}

}  // namespace tools
