// SPDX-License-Identifier: MIT
// FNV-1a, 128 bits: names cache entries and detects damage. Not for adversaries.
#pragma once
#include <cstddef>
#include <string>

namespace penumbra::runtime {

/// 32 hexadecimal digits.
std::string digest(const void* data, std::size_t bytes);
inline std::string digest(const std::string& text) {
    return digest(text.data(), text.size());
}

}  // namespace penumbra::runtime
