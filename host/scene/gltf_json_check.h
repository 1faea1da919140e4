// SPDX-License-Identifier: MIT
// A look at the JSON text before tinygltf parses it.
#pragma once
#include <cstddef>
#include <string_view>

namespace penumbra::scene {

/// Throws Error for what tinygltf would crash on or read as something else: deep nesting (it
/// recurses), values of another type than glTF 2.0 has under that name (it leaves them out), and
/// indices, counts, offsets or lengths that are negative, fractional or beyond 2^31 - 1 (it wraps
/// them, or puts 0). Text that is no JSON passes; tinygltf reports that. Returns the number of
/// buffers.
std::size_t checkJson(std::string_view text);

}  // namespace penumbra::scene
