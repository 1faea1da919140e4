// SPDX-License-Identifier: MIT
// Numbers out of the loosely typed values in which tinygltf keeps extensions and extras.
#pragma once
#include <tiny_gltf.h>

#include <optional>
#include <string>

#include "runtime/error.h"

namespace penumbra::scene {

/// The member as a number; `otherwise` where it is absent; throws Error for another type.
inline double readNumber(const tinygltf::Value& object, const char* key, double otherwise,
                         const std::string& user) {
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    require(value.IsNumber(), "{} has a '{}' that is not a number", user, key);
    return value.GetNumberAsDouble();
}

/// The member as `Vector`, which holds the default; throws Error for another type or length.
template <typename Vector>
Vector readVector(const tinygltf::Value& object, const char* key, Vector otherwise,
                  const std::string& user) {
    if (!object.IsObject() || !object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    require(value.IsArray() && value.ArrayLen() == static_cast<std::size_t>(Vector::length()),
            "{} has a '{}' that is not an array of {} numbers", user, key, Vector::length());
    for (int i = 0; i < Vector::length(); ++i) {
        require(value.Get(i).IsNumber(), "{} has a '{}' that is not an array of numbers", user,
                key);
        otherwise[i] = static_cast<typename Vector::value_type>(value.Get(i).GetNumberAsDouble());
    }
    return otherwise;
}

/// The extension's value, or null.
inline const tinygltf::Value* findExtension(const tinygltf::ExtensionMap& extensions,
                                            const char* name) {
    const auto found = extensions.find(name);
    return found == extensions.end() ? nullptr : &found->second;
}

}  // namespace penumbra::scene
