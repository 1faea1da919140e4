// SPDX-License-Identifier: MIT
// EXR and PNG files. OpenEXR and libpng end here.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/penumbra.h"

namespace penumbra::image {

/// Sides and pixels of the largest image that is read, those of the largest frame that is rendered,
/// and the largest sum of an image's planes: a header of a hundred bytes can name any number of
/// them. A fuzzer's time goes to parsers, not to the filling of memory.
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
constexpr int kMaxSide = 256;
constexpr std::uint64_t kMaxPixels = 10'000, kMaxPlaneBytes = 1ULL << 20U;
#else
constexpr int kMaxSide = 16384;
constexpr std::uint64_t kMaxPixels = 90'000'000, kMaxPlaneBytes = 8ULL << 30U;
#endif

/// Throws Error for a size, as told by a file's header, beyond these limits.
void requireReadable(int width, int height, std::size_t channels);

/// An image read back: named planes of width * height floats (uint channels converted).
struct LoadedImage {
    int width = 0, height = 0;
    bool srgb = false;  ///< R, G, B are sRGB-encoded (PNG), not linear (EXR)
    std::vector<Channel> channels;
    std::vector<std::pair<std::string, std::string>> header;
    const std::vector<float>* find(const std::string& name) const;
};

/// Reads .exr (all channels) or .png (R G B A as stored, 0 to 1). Throws Error naming the file.
LoadedImage readImage(const std::string& path);

/// A PNG file of sRGB bytes [height, width, 3] in memory; a fingerprint goes into a text chunk.
std::vector<std::uint8_t> encodePng(const std::vector<std::uint8_t>& rgb, int width, int height,
                                    const std::string& fingerprint = "");

void writeExrFile(const std::string& path, const Frame& frame);
LoadedImage readExrFile(const std::string& path);
LoadedImage readPngFile(const std::string& path);

}  // namespace penumbra::image
