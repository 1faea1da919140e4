// SPDX-License-Identifier: MIT
#include <png.h>

#include <cstdio>
#include <memory>

#include "host/image/image_file.h"
#include "runtime/error.h"

namespace penumbra::image {
namespace {

constexpr int kFrameCompression = 4;  // frames are written while others render

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

[[noreturn]] void throwPng(png_structp, png_const_charp message) {
    throw Error(message);
}

void ignoreWarning(png_structp, png_const_charp) {}

File openFile(const std::string& path, const char* mode) {
    File file(std::fopen(path.c_str(), mode));
    require(file != nullptr, "{}: cannot be opened", path);
    return file;
}

struct Writer {
    png_structp png =
        png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, throwPng, ignoreWarning);
    png_infop info = png_create_info_struct(png);
    Writer() = default;
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    ~Writer() { png_destroy_write_struct(&png, &info); }
};

struct Reader {
    png_structp png =
        png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, throwPng, ignoreWarning);
    png_infop info = png_create_info_struct(png);
    Reader() = default;
    Reader(const Reader&) = delete;
    Reader& operator=(const Reader&) = delete;
    ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

void addText(std::string key, std::string value, Writer& w) {
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = key.data();
    text.text = value.data();
    text.text_length = value.size();
    png_set_text(w.png, w.info, &text, 1);
}

}  // namespace

std::vector<std::uint8_t> encodePng(const std::vector<std::uint8_t>& rgb, int width, int height,
                                    const std::string& fingerprint) {
    std::vector<std::uint8_t> bytes;
    Writer w;
    png_set_write_fn(
        w.png, &bytes,
        [](png_structp png, png_bytep data, png_size_t size) {
            auto* out = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
            out->insert(out->end(), data, data + size);
        },
        nullptr);
    png_set_IHDR(w.png, w.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height),
                 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    if (!fingerprint.empty()) png_set_compression_level(w.png, kFrameCompression);
    png_set_sRGB(w.png, w.info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!fingerprint.empty()) addText("penumbra.fingerprint", fingerprint, w);
    png_write_info(w.png, w.info);
    for (int y = 0; y < height; ++y)
        png_write_row(
            w.png, rgb.data() + 3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(width));
    png_write_end(w.png, nullptr);
    return bytes;
}

LoadedImage readPngFile(const std::string& path) try {
    const File file = openFile(path, "rb");
    Reader r;
    png_init_io(r.png, file.get());
    png_set_user_limits(r.png, 32768, 32768);
    png_read_info(r.png, r.info);
    png_set_expand(r.png);
    png_set_strip_16(r.png);
    png_set_gray_to_rgb(r.png);
    png_set_add_alpha(r.png, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(r.png);
    png_read_update_info(r.png, r.info);
    LoadedImage image;
    image.srgb = true;
    image.width = static_cast<int>(png_get_image_width(r.png, r.info));
    image.height = static_cast<int>(png_get_image_height(r.png, r.info));
    const auto rowBytes = png_get_rowbytes(r.png, r.info);
    std::vector<png_byte> texels(rowBytes * static_cast<std::size_t>(image.height));
    std::vector<png_bytep> rows;
    rows.reserve(static_cast<std::size_t>(image.height));
    for (int y = 0; y < image.height; ++y)
        rows.push_back(texels.data() + rowBytes * static_cast<std::size_t>(y));
    png_read_image(r.png, rows.data());
    png_read_end(r.png, r.info);
    const char* names[] = {"R", "G", "B", "A"};
    for (std::size_t c = 0; c < 4; ++c) {
        Channel channel{names[c], {}, {}};
        for (std::size_t i = c; i < texels.size(); i += 4)
            channel.values.push_back(static_cast<float>(texels[i]) / 255);
        image.channels.push_back(std::move(channel));
    }
    png_textp text = nullptr;
    int count = 0;
    png_get_text(r.png, r.info, &text, &count);
    for (int i = 0; i < count; ++i) image.header.emplace_back(text[i].key, text[i].text);
    return image;
} catch (const std::exception& error) {
    throw Error(fmt::format("{}: not a readable PNG file: {}", path, error.what()));
}

}  // namespace penumbra::image
