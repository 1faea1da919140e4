// SPDX-License-Identifier: MIT
// Checked reading of accessors. Offsets, strides and counts are checked in 64 bits against the
// buffer before anything is allocated; sparse parts replace their base, or zeros where there is
// none.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/scene/gltf_context.h"

namespace penumbra::scene {

/// Bytes of one buffer view, inside of its buffer.
struct ByteSpan {
    const unsigned char* data = nullptr;
    std::uint64_t size = 0;
};

/// Throws Error unless the view and its buffer are there and the range lies inside of it.
ByteSpan checkBufferView(const LoadContext& context, int view, const std::string& user);

/// Components of one element: 1 to 4, or 16; throws Error for an index out of range and other
/// types.
int componentCount(const LoadContext& context, int accessor, const std::string& user);
/// True for floats (the file's numbers as they are), false for integers of any size.
bool holdsFloats(const LoadContext& context, int accessor);

/// All elements as floats, normalised integers mapped to [0, 1] or [-1, 1]: [count, components].
/// `user` names who asks, for messages. Takes float and 8- or 16-bit integer accessors.
std::vector<float> readFloats(LoadContext& context, int accessor, int components,
                              const std::string& user);

/// All elements of unsigned integers of 8, 16 or 32 bits: [count, components].
std::vector<std::uint32_t> readIntegers(LoadContext& context, int accessor, int components,
                                        const std::string& user);

/// readFloats for a glm vector type, as [count].
template <typename Vector>
std::vector<Vector> readVectors(LoadContext& context, int accessor, const std::string& user) {
    constexpr int kComponents = Vector::length();
    const std::vector<float> flat = readFloats(context, accessor, kComponents, user);
    std::vector<Vector> vectors(flat.size() / kComponents);
    for (std::size_t i = 0; i < vectors.size(); ++i)
        for (int c = 0; c < kComponents; ++c)
            vectors[i][c] = flat[i * kComponents + static_cast<std::size_t>(c)];
    return vectors;
}

}  // namespace penumbra::scene
