// SPDX-License-Identifier: MIT
#include "host/geometry/materials.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace penumbra::geometry {
namespace {

float decodeSrgb(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

const std::array<float, 256>& srgbTable() {
    static const auto table = [] {
        std::array<float, 256> values{};
        for (std::size_t i = 0; i < 256; ++i)
            values[i] = decodeSrgb(static_cast<float>(i) / 255.0F);
        return values;
    }();
    return table;
}

std::uint8_t encodeSrgb(float linear) {
    const float encoded =
        linear <= 0.0031308F ? linear * 12.92F : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
    return static_cast<std::uint8_t>(std::lround(std::clamp(encoded, 0.0F, 1.0F) * 255));
}

std::uint32_t averageTexel(const std::uint32_t (&texels)[4], bool srgb) {
    std::uint32_t packed = 0;
    for (int channel = 0; channel < 4; ++channel) {
        const bool decode = srgb && channel < 3;
        float sum = 0;
        for (const auto texel : texels) {
            const auto byte = (texel >> (8 * channel)) & 255;
            sum += decode ? srgbTable()[byte] : static_cast<float>(byte);
        }
        const auto byte =
            decode ? encodeSrgb(sum / 4) : static_cast<std::uint8_t>(std::lround(sum / 4));
        packed |= static_cast<std::uint32_t>(byte) << (8 * channel);
    }
    return packed;
}

/// Alpha becomes 255 where the alpha test passes, else 0; next to the cutoff, where the edge of
/// what passes lies within the texel, something between.
std::uint32_t testAlpha(std::uint32_t texel, float cutoff) {
    constexpr float kSharpness = 8;
    const float above = static_cast<float>(texel >> 24) / 255 - cutoff;
    const auto share = std::clamp(kSharpness * above + 0.5F, 0.0F, 1.0F);
    return (texel & 0xffffffU) | static_cast<std::uint32_t>(std::lround(255 * share)) << 24;
}

/// Appends an image and its MIP levels down to 1 x 1; returns the number of levels. With a cutoff,
/// alpha of levels above 0 is the share of level 0 that passes the test.
int appendImage(const scene::Image& image, bool srgb, std::optional<float> cutoff,
                std::vector<std::uint32_t>& texels) {
    std::size_t level = texels.size();
    for (std::size_t i = 0; i + 3 < image.texels.size(); i += 4)
        texels.push_back(static_cast<std::uint32_t>(image.texels[i]) |
                         static_cast<std::uint32_t>(image.texels[i + 1]) << 8 |
                         static_cast<std::uint32_t>(image.texels[i + 2]) << 16 |
                         static_cast<std::uint32_t>(image.texels[i + 3]) << 24);
    int width = image.width, height = image.height, levels = 1;
    while (width > 1 || height > 1) {
        const int w = std::max(width / 2, 1), h = std::max(height / 2, 1);
        const std::size_t next = texels.size();
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const auto at = [&](int dx, int dy) {
                    const int sx = std::min(2 * x + dx, width - 1),
                              sy = std::min(2 * y + dy, height - 1);
                    const auto texel =
                        texels[level +
                               static_cast<std::size_t>(sy) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(sx)];
                    return cutoff && levels == 1 ? testAlpha(texel, *cutoff) : texel;
                };
                texels.push_back(averageTexel({at(0, 0), at(1, 0), at(0, 1), at(1, 1)}, srgb));
            }
        level = next;
        width = w;
        height = h;
        ++levels;
    }
    return levels;
}

class TexturePacker {
  public:
    TexturePacker(const scene::Scene& scene, std::vector<std::uint32_t>& texels)
        : scene_(scene), texels_(texels) {}

    shared::Texture pack(const scene::TextureRef& ref, bool srgb,
                         std::optional<float> cutoff = {}) {
        shared::Texture t{};
        t.offset = -1;
        t.levels = 1;
        if (ref.image < 0) return t;
        const auto& image = scene_.images[static_cast<std::size_t>(ref.image)];
        if (image.texels.empty()) return t;
        auto [entry, isNew] = packed_.try_emplace({ref.image, srgb, cutoff});
        if (isNew) {
            entry->second.offset = static_cast<int>(texels_.size());
            entry->second.levels = appendImage(image, srgb, cutoff, texels_);
        }
        t.offset = entry->second.offset;
        t.levels = entry->second.levels;
        t.width = image.width;
        t.height = image.height;
        t.uvSet = ref.uvSet;
        t.wrap = static_cast<int>(ref.wrapU) | static_cast<int>(ref.wrapV) << 2 |
                 (ref.nearest ? 16 : 0) | (srgb ? 32 : 0);
        const auto& m = ref.uvFromUv;
        t.a = m[0][0], t.b = m[1][0], t.c = m[2][0];
        t.d = m[0][1], t.e = m[1][1], t.f = m[2][1];
        return t;
    }

  private:
    struct Packed {
        int offset = 0, levels = 1;
    };
    const scene::Scene& scene_;
    std::vector<std::uint32_t>& texels_;
    std::map<std::tuple<int, bool, std::optional<float>>, Packed> packed_;
};

/// True if every alpha between those of the texels blends.
bool alwaysBlends(const scene::Scene& scene, const scene::Material& m) {
    if (m.alphaMode != scene::AlphaMode::blend) return false;
    std::uint8_t low = 255, high = 255;
    const int index = m.baseColorTexture.image;
    if (index >= 0) {
        const auto& texels = scene.images[static_cast<std::size_t>(index)].texels;
        if (!texels.empty()) high = 0;
        for (std::size_t i = 3; i < texels.size(); i += 4) {
            low = std::min(low, texels[i]);
            high = std::max(high, texels[i]);
        }
    }
    const float alpha = m.baseColor.w / 255;
    return alpha * static_cast<float>(low) > 0 &&
           (m.transmission > 0 || alpha * static_cast<float>(high) < BLEND_OPAQUE_ALPHA);
}

}  // namespace

MaterialArrays packMaterials(const scene::Scene& scene) {
    MaterialArrays arrays;
    for (const float value : srgbTable())
        arrays.texels.push_back(std::bit_cast<std::uint32_t>(value));
    TexturePacker packer(scene, arrays.texels);
    for (const auto& m : scene.materials) {
        shared::Material out{};
        std::optional<float> cutoff;  // of the texture alone
        if (m.alphaMode == scene::AlphaMode::mask)
            cutoff = m.alphaCutoff / std::max(m.baseColor.w, 1e-6F);
        out.baseColorTexture = packer.pack(m.baseColorTexture, true, cutoff);
        out.metallicRoughnessTexture = packer.pack(m.metallicRoughnessTexture, false);
        out.normalTexture = packer.pack(m.normalTexture, false);
        out.emissiveTexture = packer.pack(m.emissiveTexture, true);
        out.baseColor = {m.baseColor.x, m.baseColor.y, m.baseColor.z, m.baseColor.w};
        out.emissive = {m.emissive.x, m.emissive.y, m.emissive.z, 0};
        out.metallic = m.metallic;
        out.roughness = m.roughness;
        out.normalScale = m.normalScale;
        out.alphaCutoff = m.alphaCutoff;
        out.transmission = m.transmission;
        out.flags = m.alphaMode == scene::AlphaMode::opaque ? MATERIAL_OPAQUE : 0;
        if (alwaysBlends(scene, m)) out.flags |= MATERIAL_BLENDS;
        arrays.materials.push_back(out);
    }
    return arrays;
}

}  // namespace penumbra::geometry
