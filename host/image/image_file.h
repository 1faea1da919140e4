// SPDX-License-Identifier: MIT
// EXR and PNG files. OpenEXR and libpng end here.
#pragma once
#include <string>
#include <vector>

#include "host/penumbra.h"

namespace penumbra::image {

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
