// SPDX-License-Identifier: MIT
#include "host/image/frame_planes.h"

#include <bit>
#include <cmath>
#include <limits>

#include "host/pipeline.h"
#include "kernels/shared/gbuffer.h"

namespace penumbra::image {
namespace {

std::size_t sampleIndex(const FramePlanes& p, int x, int y, int dx, int dy) {
    const int s = p.supersample;
    return static_cast<std::size_t>(y * s + dy) * static_cast<std::size_t>(p.width * s) +
           static_cast<std::size_t>(x * s + dx);
}

/// The entry that channels beside colour show there.
std::size_t frontIndex(const FramePlanes& p, int x, int y, int dx, int dy) {
    const auto pixel = sampleIndex(p, x, y, dx, dy);
    return p.front.empty() ? pixel : p.front[pixel];
}

/// Calls fn(output index, x, y) for each pixel.
template <typename Fn>
void forPixels(const FramePlanes& p, Fn&& fn) {
    std::size_t out = 0;
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) fn(out++, x, y);
}

std::vector<float> averaged(const FramePlanes& p, const float* plane) {
    std::vector<float> values(static_cast<std::size_t>(p.width) *
                              static_cast<std::size_t>(p.height));
    const int s = p.supersample;
    forPixels(p, [&](std::size_t out, int x, int y) {
        float sum = 0;
        for (int dy = 0; dy < s; ++dy)
            for (int dx = 0; dx < s; ++dx) sum += plane[frontIndex(p, x, y, dx, dy)];
        values[out] = sum / static_cast<float>(s * s);
    });
    return values;
}

std::vector<float> picked(const FramePlanes& p, const float* plane) {
    std::vector<float> values(static_cast<std::size_t>(p.width) *
                              static_cast<std::size_t>(p.height));
    const int middle = p.supersample / 2;
    forPixels(p, [&](std::size_t out, int x, int y) {
        values[out] = plane[frontIndex(p, x, y, middle, middle)];
    });
    return values;
}

void addPlanes(const FramePlanes& p, const std::vector<std::string>& names, int plane, bool average,
               Frame& frame) {
    for (std::size_t i = 0; i < names.size(); ++i) {
        const float* values = p.gbuffer.data() + (static_cast<std::size_t>(plane) + i) *
                                                     static_cast<std::size_t>(p.stride);
        frame.channels.push_back({names[i], average ? averaged(p, values) : picked(p, values), {}});
    }
}

void addSurfaces(const FramePlanes& p, const AovChoice& aovs, const glm::dvec3& centre,
                 Frame& frame) {
    if (aovs.depth) addPlanes(p, {"Z"}, GB_DEPTH, false, frame);
    if (aovs.position) {
        const auto first = frame.channels.size();
        addPlanes(p, {"P.X", "P.Y", "P.Z"}, GB_POSITION, false, frame);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (auto& value : frame.channels[first + axis].values)
                value = static_cast<float>(value + centre[static_cast<int>(axis)]);
    }
    if (aovs.normal) addPlanes(p, {"N.X", "N.Y", "N.Z"}, GB_NORMAL, false, frame);
    if (aovs.albedo) addPlanes(p, {"albedo.R", "albedo.G", "albedo.B"}, GB_ALBEDO, true, frame);
    if (aovs.id) {
        addPlanes(p, {"id.object"}, GB_OBJECT, false, frame);
        auto& channel = frame.channels.back();
        for (const float bits : channel.values)
            channel.ids.push_back(std::bit_cast<std::uint32_t>(bits));
        channel.values.clear();
    }
}

}  // namespace

Frame assembleFrame(const FramePlanes& p, const AovChoice& aovs, const glm::dvec3& centre) {
    Frame frame;
    frame.width = p.width;
    frame.height = p.height;
    frame.rgba.resize(4 * static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height));
    const auto stride = static_cast<std::size_t>(p.stride);
    const float* objects =
        p.gbuffer.empty() ? p.objects.data() : p.gbuffer.data() + GB_OBJECT * stride;
    const int s = p.supersample;
    const float share = 1.0F / static_cast<float>(s * s);
    forPixels(p, [&](std::size_t out, int x, int y) {
        float sum[4] = {0, 0, 0, 0};
        for (int dy = 0; dy < s; ++dy)
            for (int dx = 0; dx < s; ++dx) {
                const auto i = sampleIndex(p, x, y, dx, dy);
                for (std::size_t c = 0; c < 3; ++c) sum[c] += p.colour[c * stride + i];
                const bool covered = std::bit_cast<std::uint32_t>(objects[i]) != 0;
                sum[3] += p.alpha.empty() ? (covered ? 1.0F : 0.0F) : p.alpha[i];
            }
        for (std::size_t c = 0; c < 4; ++c) frame.rgba[4 * out + c] = sum[c] * share;
    });
    addSurfaces(p, aovs, centre, frame);
    return frame;
}

void addVisibility(const FramePlanes& p, const std::string& light,
                   const std::vector<float>& visibility, Frame& frame) {
    const auto stride = static_cast<std::size_t>(p.stride);
    const std::size_t channels = visibility.size() / stride;
    const char* suffix[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        const float* plane = visibility.data() + (channels == 3 ? c * stride : 0);
        frame.channels.push_back({"visibility." + light + "." + suffix[c], averaged(p, plane), {}});
    }
}

void addMasks(const FramePlanes& p, const std::string& light,
              const visibility::OcclusionMasks& masks, Frame& frame) {
    frame.maskWidth = p.width * p.supersample;
    frame.maskHeight = p.height * p.supersample;
    frame.maskCells.emplace_back(light, fmt::format("{}x{}", masks.columns, masks.rows));
    const auto pixels =
        static_cast<std::size_t>(frame.maskWidth) * static_cast<std::size_t>(frame.maskHeight);
    for (int plane = 0; plane < masks.rows * masks.words(); ++plane) {
        const auto* words = masks.bits.data() + static_cast<std::size_t>(plane) * masks.stride;
        std::vector<std::uint32_t> bits(words, words + pixels);
        for (std::size_t i = 0; i < p.front.size(); ++i) bits[i] = words[p.front[i]];
        frame.masks.push_back(
            {fmt::format("{}.{:02}.{}", light, plane / masks.words(), plane % masks.words()),
             {},
             std::move(bits)});
    }
}

void addDepthMaps(const std::string& light, const visibility::DepthMaps& maps, Frame& frame) {
    frame.depthMapSize = maps.size;
    const auto texels = static_cast<std::size_t>(maps.size) * static_cast<std::size_t>(maps.size);
    for (int view = 0; view < maps.views; ++view) {
        const auto first = maps.depths.begin() +
                           static_cast<std::ptrdiff_t>(static_cast<std::size_t>(view) * texels);
        frame.depthMaps.push_back({fmt::format("{}.{:04}", light, view),
                                   {first, first + static_cast<std::ptrdiff_t>(texels)},
                                   {}});
    }
}

}  // namespace penumbra::image
