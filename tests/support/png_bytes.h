// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>

namespace penumbra::tests {

/// A PNG file whose header tells width x height RGB pixels, and whose data are one stored block of
/// at most 65535 bytes: black pixels, as many as fit. `tail` follows them in the compressed stream.
std::string pngBytes(std::uint32_t width, std::uint32_t height, const std::string& tail = "");

}  // namespace penumbra::tests
