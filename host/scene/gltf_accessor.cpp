// SPDX-License-Identifier: MIT
// Reads accessors; see the header. glTF 2.0 sections 3.6.2 (accessors) and 3.6.2.3 (sparse).
#include "host/scene/gltf_accessor.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

namespace penumbra::scene {

namespace {

/// An accessor whose every element lies inside of its buffer.
struct CheckedAccessor {
    const unsigned char* base = nullptr;  ///< first element; null: all zeros
    std::uint64_t strideBytes = 0, count = 0;
    int componentType = 0, components = 0;
    bool normalized = false;
    std::uint64_t sparseCount = 0;
    const unsigned char* sparseIndices = nullptr;
    const unsigned char* sparseValues = nullptr;  ///< packed elements
    int sparseIndexType = 0;
    std::string name;  ///< for messages
};

std::uint64_t componentBytes(int componentType, const std::string& name) {
    switch (componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            throw Error(fmt::format("{} has componentType {}; allowed are 5120 to 5123, 5125, 5126",
                                    name, componentType));
    }
}

/// The bytes from `offset` on must hold `count` elements, each `strideBytes` after the one before.
const unsigned char* checkRange(const ByteSpan& view, std::uint64_t offset, std::uint64_t count,
                                std::uint64_t strideBytes, std::uint64_t elementBytes,
                                const std::string& name) {
    const bool fits = offset <= view.size && elementBytes <= view.size - offset &&
                      count - 1 <= (view.size - offset - elementBytes) / strideBytes;
    require(fits,
            "{} has {} elements of {} bytes, {} apart from offset {}, which is more than the {} "
            "bytes of its bufferView",
            name, count, elementBytes, strideBytes, offset, view.size);
    return view.data + offset;
}

void checkSparse(const LoadContext& context, const tinygltf::Accessor& accessor,
                 std::uint64_t elementBytes, CheckedAccessor& checked) {
    const auto& sparse = accessor.sparse;
    require(sparse.count >= 1 && static_cast<std::uint64_t>(sparse.count) <= checked.count,
            "{} has {} sparse elements; allowed are 1 to its count, {}", checked.name, sparse.count,
            checked.count);
    const int indexType = sparse.indices.componentType;
    require(indexType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                indexType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                indexType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
            "{} has sparse indices of componentType {}; allowed are 5121, 5123, 5125", checked.name,
            indexType);
    require(sparse.indices.byteOffset >= 0 && sparse.values.byteOffset >= 0,
            "{} has a negative sparse byteOffset", checked.name);
    checked.sparseCount = static_cast<std::uint64_t>(sparse.count);
    checked.sparseIndexType = indexType;
    const std::uint64_t indexBytes = componentBytes(indexType, checked.name);
    checked.sparseIndices =
        checkRange(checkBufferView(context, sparse.indices.bufferView, checked.name),
                   static_cast<std::uint64_t>(sparse.indices.byteOffset), checked.sparseCount,
                   indexBytes, indexBytes, checked.name + " (sparse indices)");
    checked.sparseValues =
        checkRange(checkBufferView(context, sparse.values.bufferView, checked.name),
                   static_cast<std::uint64_t>(sparse.values.byteOffset), checked.sparseCount,
                   elementBytes, elementBytes, checked.name + " (sparse values)");
}

CheckedAccessor checkAccessor(const LoadContext& context, int index, int components,
                              const std::string& user) {
    const int found = componentCount(context, index, user);
    const tinygltf::Accessor& accessor = context.model.accessors[static_cast<std::size_t>(index)];
    CheckedAccessor checked;
    checked.name = fmt::format("accessor {} ({})", index, user);
    require(found == components, "{} has {} components per element; {} are needed", checked.name,
            found, components);
    require(accessor.count >= 1, "{} has no elements", checked.name);
    checked.count = accessor.count;
    checked.componentType = accessor.componentType;
    checked.components = components;
    checked.normalized = accessor.normalized;
    const std::uint64_t elementBytes = componentBytes(accessor.componentType, checked.name) *
                                       static_cast<std::uint64_t>(components);
    require(accessor.bufferView >= -1, "{} refers to bufferView {}", checked.name,
            accessor.bufferView);
    if (accessor.bufferView >= 0) {
        const ByteSpan view = checkBufferView(context, accessor.bufferView, checked.name);
        const std::uint64_t stride =
            context.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
        require(stride == 0 || stride >= elementBytes,
                "{} has elements of {} bytes in a bufferView with byteStride {}", checked.name,
                elementBytes, stride);
        checked.strideBytes = stride == 0 ? elementBytes : stride;
        checked.base = checkRange(view, accessor.byteOffset, checked.count, checked.strideBytes,
                                  elementBytes, checked.name);
    }
    if (accessor.sparse.isSparse) checkSparse(context, accessor, elementBytes, checked);
    return checked;
}

template <typename Number>
Number load(const unsigned char* bytes) {  // elements may lie unaligned in hostile files
    Number number;
    std::memcpy(&number, bytes, sizeof number);
    return number;
}

std::uint32_t loadIndex(const unsigned char* bytes, int componentType) {
    if (componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE) return *bytes;
    if (componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) return load<std::uint16_t>(bytes);
    return load<std::uint32_t>(bytes);
}

/// Copies all elements, then the sparse ones, through `convert(Number) -> Out`.
template <typename Number, typename Out, typename Convert>
void copyElements(const CheckedAccessor& accessor, std::vector<Out>& out, const Convert& convert) {
    const auto components = static_cast<std::uint64_t>(accessor.components);
    const auto copyOne = [&](const unsigned char* from, std::uint64_t element) {
        for (std::uint64_t c = 0; c < components; ++c)
            out[element * components + c] = convert(load<Number>(from + c * sizeof(Number)));
    };
    if (accessor.base != nullptr)
        for (std::uint64_t i = 0; i < accessor.count; ++i)
            copyOne(accessor.base + i * accessor.strideBytes, i);
    const std::uint64_t indexBytes =
        accessor.sparseCount == 0 ? 0 : componentBytes(accessor.sparseIndexType, accessor.name);
    for (std::uint64_t i = 0; i < accessor.sparseCount; ++i) {
        const std::uint32_t element =
            loadIndex(accessor.sparseIndices + i * indexBytes, accessor.sparseIndexType);
        require(element < accessor.count, "{} has the sparse index {}; its count is {}",
                accessor.name, element, accessor.count);
        copyOne(accessor.sparseValues + i * components * sizeof(Number), element);
    }
}

template <typename Number>
void copyAsFloats(const CheckedAccessor& accessor, std::vector<float>& out) {
    if constexpr (std::is_same_v<Number, float>) {
        copyElements<float>(accessor, out, [](float number) { return number; });
    } else if (!accessor.normalized) {
        copyElements<Number>(accessor, out,
                             [](Number number) { return static_cast<float>(number); });
    } else {
        constexpr auto kLargest = static_cast<float>(std::numeric_limits<Number>::max());
        copyElements<Number>(accessor, out, [](Number number) {
            return std::max(static_cast<float>(number) / kLargest, -1.0F);
        });
    }
}

}  // namespace

ByteSpan checkBufferView(const LoadContext& context, int view, const std::string& user) {
    checkIndex(view, context.model.bufferViews.size(), user, "bufferView");
    const tinygltf::BufferView& found = context.model.bufferViews[static_cast<std::size_t>(view)];
    checkIndex(found.buffer, context.model.buffers.size(), fmt::format("bufferView {}", view),
               "buffer");
    const auto& bytes = context.model.buffers[static_cast<std::size_t>(found.buffer)].data;
    require(found.byteLength <= bytes.size() && found.byteOffset <= bytes.size() - found.byteLength,
            "bufferView {} takes {} bytes from offset {} of buffer {}, which has {}", view,
            found.byteLength, found.byteOffset, found.buffer, bytes.size());
    return {bytes.data() + found.byteOffset, found.byteLength};
}

int componentCount(const LoadContext& context, int accessor, const std::string& user) {
    checkIndex(accessor, context.model.accessors.size(), user, "accessor");
    switch (context.model.accessors[static_cast<std::size_t>(accessor)].type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        case TINYGLTF_TYPE_MAT4:
            return 16;
        default:
            throw Error(
                fmt::format("accessor {} ({}) holds 2x2 or 3x3 matrices; nothing in a scene "
                            "uses these",
                            accessor, user));
    }
}

bool holdsFloats(const LoadContext& context, int accessor) {
    return context.model.accessors[static_cast<std::size_t>(accessor)].componentType ==
           TINYGLTF_COMPONENT_TYPE_FLOAT;
}

namespace {

/// What `checked` takes as elements of 4 bytes, before it is taken.
void chargeElements(LoadContext& context, const CheckedAccessor& checked, int components) {
    const std::uint64_t bytesEach = 4 * static_cast<std::uint64_t>(components);
    if (checked.base == nullptr) context.chargeZeros(checked.count, bytesEach, checked.name);
    context.charge(checked.count, bytesEach, checked.name);
}

}  // namespace

std::vector<float> readFloats(LoadContext& context, int accessor, int components,
                              const std::string& user) {
    const CheckedAccessor checked = checkAccessor(context, accessor, components, user);
    require(checked.componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
            "{} has componentType 5125 (32-bit integers); only indices may have that",
            checked.name);
    chargeElements(context, checked, components);
    std::vector<float> out(checked.count * static_cast<std::uint64_t>(components));
    switch (checked.componentType) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            copyAsFloats<std::int8_t>(checked, out);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            copyAsFloats<std::uint8_t>(checked, out);
            break;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            copyAsFloats<std::int16_t>(checked, out);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            copyAsFloats<std::uint16_t>(checked, out);
            break;
        default:
            copyAsFloats<float>(checked, out);
    }
    return out;
}

std::vector<std::uint32_t> readIntegers(LoadContext& context, int accessor, int components,
                                        const std::string& user) {
    const CheckedAccessor checked = checkAccessor(context, accessor, components, user);
    chargeElements(context, checked, components);
    std::vector<std::uint32_t> out(checked.count * static_cast<std::uint64_t>(components));
    const auto widen = [](auto number) { return static_cast<std::uint32_t>(number); };
    switch (checked.componentType) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            copyElements<std::uint8_t>(checked, out, widen);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            copyElements<std::uint16_t>(checked, out, widen);
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            copyElements<std::uint32_t>(checked, out, widen);
            break;
        default:
            throw Error(fmt::format(
                "{} has componentType {}; unsigned integers (5121, 5123, 5125) are needed",
                checked.name, checked.componentType));
    }
    return out;
}

}  // namespace penumbra::scene
