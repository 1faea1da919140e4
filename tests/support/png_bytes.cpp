// SPDX-License-Identifier: MIT
// PNG 1.2 with a stored deflate block (RFC 1950, 1951).
#include "tests/support/png_bytes.h"

#include <algorithm>

namespace penumbra::tests {
namespace {

std::string bigEndian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
    return bytes;
}

std::uint32_t crc32(const std::string& bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1U) ^ (crc & 1U ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

std::string chunk(const std::string& type, const std::string& data) {
    return bigEndian(static_cast<std::uint32_t>(data.size())) + type + data +
           bigEndian(crc32(type + data));
}

/// Zeros as one stored block; the last one of the stream unless a tail follows.
std::string stored(std::size_t count, const std::string& tail) {
    std::string bytes("\x78\x01", 2);
    bytes += static_cast<char>(tail.empty() ? 1 : 0);
    for (const std::size_t word : {count, ~count})
        for (const unsigned shift : {0U, 8U}) bytes += static_cast<char>(word >> shift & 0xFFU);
    bytes += std::string(count, '\0');
    // Adler-32 of `count` zeros
    return bytes + (tail.empty() ? bigEndian(static_cast<std::uint32_t>(count) << 16U | 1U) : tail);
}

}  // namespace

std::string pngBytes(std::uint32_t width, std::uint32_t height, const std::string& tail) {
    const std::string header =
        bigEndian(width) + bigEndian(height) + std::string("\x08\x02\0\0\0", 5);
    const double wanted = (3.0 * width + 1) * height;
    const auto count = static_cast<std::size_t>(std::min(wanted, 65520.0));
    return "\x89PNG\r\n\x1A\n" + chunk("IHDR", header) + chunk("IDAT", stored(count, tail)) +
           chunk("IEND", "");
}

}  // namespace penumbra::tests
