// SPDX-License-Identifier: MIT
#include "host/image/png.h"

#include <png.h>

#include <cstdio>
#include <memory>
#include <span>
#include <utility>

#include "host/image/image_file.h"
#include "runtime/error.h"
#include "runtime/one_line.h"

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

/// A file on its way through libpng's progressive reader, which stops to inflate at the last pixel.
/// The other reader inflates a hostile stream to its end.
struct Decoding {
    PngPixels pixels;
    std::size_t rowBytes = 0;
    bool whole = false;
};

Decoding& decodingOf(png_structp png) {
    return *static_cast<Decoding*>(png_get_progressive_ptr(png));
}

void startPixels(png_structp png, png_infop info) {
    auto& decoding = decodingOf(png);
    auto& pixels = decoding.pixels;
    pixels.width = static_cast<int>(png_get_image_width(png, info));
    pixels.height = static_cast<int>(png_get_image_height(png, info));
    requireReadable(pixels.width, pixels.height, 4);
    png_set_expand(png);
    png_set_strip_16(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 255, PNG_FILLER_AFTER);
    png_set_interlace_handling(png);
    png_read_update_info(png, info);
    decoding.rowBytes = png_get_rowbytes(png, info);
    pixels.rgba.resize(decoding.rowBytes * static_cast<std::size_t>(pixels.height));
}

void takeRow(png_structp png, png_bytep row, png_uint_32 number, int) {
    auto& decoding = decodingOf(png);
    if (row != nullptr)  // null: this pass of an interlaced file changes nothing here
        png_progressive_combine_row(png, &decoding.pixels.rgba[number * decoding.rowBytes], row);
}

void finishPixels(png_structp png, png_infop info) {
    constexpr int kPasses = 7;
    const bool interlaced = png_get_interlace_type(png, info) == PNG_INTERLACE_ADAM7;
    const bool complete = interlaced
                              ? png_get_current_pass_number(png) >= kPasses
                              : png_get_current_row_number(png) >= png_get_image_height(png, info);
    require(complete, "it has fewer pixels than its header tells");
    decodingOf(png).whole = true;
}

/// `next` gives the file's pieces, and an empty one at its end.
template <typename Next>
PngPixels decode(const Next& next) {
    Reader r;
    Decoding decoding;
    png_set_progressive_read_fn(r.png, &decoding, startPixels, takeRow, finishPixels);
    png_set_user_limits(r.png, kMaxSide, kMaxSide);
    for (auto piece = next(); !piece.empty() && !decoding.whole; piece = next())
        // libpng takes no const; it only reads
        png_process_data(r.png, r.info, const_cast<png_bytep>(piece.data()), piece.size());
    require(decoding.whole, "it ends too early");
    png_textp text = nullptr;
    int count = 0;
    png_get_text(r.png, r.info, &text, &count);
    for (int i = 0; i < count; ++i) decoding.pixels.header.emplace_back(text[i].key, text[i].text);
    return std::move(decoding.pixels);
}

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

PngPixels decodePng(const unsigned char* bytes, std::size_t size) {
    std::span<const png_byte> rest(bytes, size);
    return decode([&] { return std::exchange(rest, {}); });
}

LoadedImage readPngFile(const std::string& path) try {
    const File file = openFile(path, "rb");
    std::vector<png_byte> buffer(1 << 16);
    PngPixels pixels = decode([&] {
        const auto size = std::fread(buffer.data(), 1, buffer.size(), file.get());
        return std::span<const png_byte>(buffer.data(), size);
    });
    LoadedImage image;
    image.srgb = true;
    image.width = pixels.width;
    image.height = pixels.height;
    image.header = std::move(pixels.header);
    const char* names[] = {"R", "G", "B", "A"};
    for (std::size_t c = 0; c < 4; ++c) {
        Channel channel{names[c], {}, {}};
        channel.values.reserve(pixels.rgba.size() / 4);
        for (std::size_t i = c; i < pixels.rgba.size(); i += 4)
            channel.values.push_back(static_cast<float>(pixels.rgba[i]) / 255);
        image.channels.push_back(std::move(channel));
    }
    return image;
} catch (const std::exception& error) {
    throw Error(fmt::format("{}: not a readable PNG file: {}", path, toOneLine(error.what())));
}

}  // namespace penumbra::image
