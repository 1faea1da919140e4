// SPDX-License-Identifier: MIT
// Materials: factors, textures with their transforms, and the extensions that struct Material
// knows.
#include <algorithm>
#include <cmath>

#include "host/scene/gltf_context.h"
#include "host/scene/gltf_value.h"

namespace penumbra::scene {

namespace {

float checkFactor(double value, double smallest, double largest, const char* property,
                  const std::string& user) {
    require(value >= smallest && value <= largest, "{} has {} = {}; allowed are {} to {}", user,
            property, value, smallest, largest);
    return static_cast<float>(value);
}

Wrap readWrap(int wrap, const std::string& user) {
    switch (wrap) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Wrap::repeat;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirror;
        default:
            throw Error(fmt::format("{} wraps by {}; allowed are 10497, 33071, 33648", user, wrap));
    }
}

void loadSampler(const LoadContext& context, int sampler, TextureRef& reference,
                 const std::string& user) {
    if (sampler < 0) return;
    checkIndex(sampler, context.model.samplers.size(), user, "sampler");
    const tinygltf::Sampler& source = context.model.samplers[static_cast<std::size_t>(sampler)];
    const std::string name = fmt::format("sampler {}", sampler);
    reference.wrapU = readWrap(source.wrapS, name);
    reference.wrapV = readWrap(source.wrapT, name);
    reference.nearest = source.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
}

/// KHR_texture_transform: uv' = offset + R S uv. R turns counter-clockwise as seen with v down, the
/// way of all viewers and the sample models; the listing in the extension's text has the other sign
/// (KhronosGroup/glTF issue 1563).
void loadTransform(const tinygltf::Value& transform, TextureRef& reference, int& uvSet,
                   const std::string& user) {
    const auto offset = readVector(transform, "offset", glm::dvec2(0), user);
    const auto scale = readVector(transform, "scale", glm::dvec2(1), user);
    const double angle = readNumber(transform, "rotation", 0, user);
    const double c = std::cos(angle), s = std::sin(angle);
    reference.uvFromUv = glm::mat3x2(
        glm::dmat3x2(c * scale.x, -s * scale.x, s * scale.y, c * scale.y, offset.x, offset.y));
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 2; ++row)
            require(std::isfinite(reference.uvFromUv[column][row]),
                    "{} has a texture transform that is not finite", user);
    const double set = readNumber(transform, "texCoord", uvSet, user);
    require(set >= 0 && set < 256 && set == std::floor(set), "{} has texCoord = {}", user, set);
    uvSet = static_cast<int>(set);
}

/// TextureInfo is one of tinygltf's three look-alikes. Absent image: the material's factor stands
/// alone.
template <typename TextureInfo>
TextureRef loadTexture(LoadContext& context, const TextureInfo& info, const char* property,
                       const std::string& material) {
    TextureRef reference;
    if (info.index < 0) return reference;
    const std::string user = fmt::format("{} {}", material, property);
    checkIndex(info.index, context.model.textures.size(), user, "texture");
    const tinygltf::Texture& texture = context.model.textures[static_cast<std::size_t>(info.index)];
    int uvSet = info.texCoord;
    loadSampler(context, texture.sampler, reference, fmt::format("texture {}", info.index));
    if (const auto* transform = findExtension(info.extensions, "KHR_texture_transform"))
        loadTransform(*transform, reference, uvSet, user);
    if (uvSet < 0 || uvSet > 1) {
        context.warn(
            fmt::format("{} uses TEXCOORD_{}; only 0 and 1 are read, so the factor is used "
                        "alone",
                        user, uvSet));
        return {};
    }
    reference.uvSet = uvSet;
    if (texture.source < 0) {
        context.warn(fmt::format(
            "texture {} has no PNG or JPEG image{}{}, so its materials use their factors alone",
            info.index, texture.extensions.empty() ? "" : ", only one of ",
            texture.extensions.empty() ? "" : texture.extensions.begin()->first));
        return {};
    }
    checkIndex(texture.source, context.model.images.size(), fmt::format("texture {}", info.index),
               "image");
    reference.image = loadImage(context, texture.source);
    if (reference.image < 0) return {};
    return reference;
}

AlphaMode readAlphaMode(const std::string& mode, const std::string& user) {
    if (mode == "OPAQUE") return AlphaMode::opaque;
    if (mode == "MASK") return AlphaMode::mask;
    require(mode == "BLEND", "{} has alphaMode \"{}\"; allowed are OPAQUE, MASK, BLEND", user,
            mode);
    return AlphaMode::blend;
}

void loadExtensions(const tinygltf::ExtensionMap& extensions, Material& material,
                    const std::string& user) {
    material.unlit = findExtension(extensions, "KHR_materials_unlit") != nullptr;
    if (const auto* strength = findExtension(extensions, "KHR_materials_emissive_strength"))
        material.emissive *= checkFactor(readNumber(*strength, "emissiveStrength", 1, user), 0,
                                         1e30, "emissiveStrength", user);
    if (const auto* transmission = findExtension(extensions, "KHR_materials_transmission"))
        material.transmission =
            checkFactor(readNumber(*transmission, "transmissionFactor", 0, user), 0, 1,
                        "transmissionFactor", user);
}

Material loadMaterial(LoadContext& context, const tinygltf::Material& source,
                      const std::string& user) {
    const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
    Material material;
    material.name = source.name;
    for (int i = 0; i < 4; ++i)
        material.baseColor[i] = checkFactor(pbr.baseColorFactor[static_cast<std::size_t>(i)], 0, 1,
                                            "baseColorFactor", user);
    for (int i = 0; i < 3; ++i)
        material.emissive[i] = checkFactor(source.emissiveFactor[static_cast<std::size_t>(i)], 0,
                                           1e6, "emissiveFactor", user);
    material.metallic = checkFactor(pbr.metallicFactor, 0, 1, "metallicFactor", user);
    material.roughness = checkFactor(pbr.roughnessFactor, 0, 1, "roughnessFactor", user);
    material.normalScale =
        checkFactor(source.normalTexture.scale, -1e6, 1e6, "normalTexture.scale", user);
    material.alphaMode = readAlphaMode(source.alphaMode, user);
    material.alphaCutoff = checkFactor(source.alphaCutoff, 0, 1e6, "alphaCutoff", user);
    material.doubleSided = source.doubleSided;
    material.baseColorTexture =
        loadTexture(context, pbr.baseColorTexture, "baseColorTexture", user);
    material.metallicRoughnessTexture =
        loadTexture(context, pbr.metallicRoughnessTexture, "metallicRoughnessTexture", user);
    material.normalTexture = loadTexture(context, source.normalTexture, "normalTexture", user);
    material.emissiveTexture =
        loadTexture(context, source.emissiveTexture, "emissiveTexture", user);
    loadExtensions(source.extensions, material, user);
    return material;
}

}  // namespace

void loadMaterials(LoadContext& context) {
    for (std::size_t i = 0; i < context.model.materials.size(); ++i) {
        const tinygltf::Material& source = context.model.materials[i];
        context.scene.materials.push_back(
            loadMaterial(context, source, describe("material", i, source.name)));
    }
}

}  // namespace penumbra::scene
