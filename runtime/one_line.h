// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace penumbra {

/// Control characters become spaces and long texts (data URIs) are cut, so that what a file or a
/// library says fits into a message of one line.
std::string toOneLine(const std::string& text);

}  // namespace penumbra
