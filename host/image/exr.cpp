// SPDX-License-Identifier: MIT
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <half.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "host/image/image_file.h"
#include "runtime/error.h"
#include "runtime/one_line.h"
#include "runtime/whole_file.h"

namespace penumbra::image {
namespace {

/// Planes on their way into a file; a deque-like owner of converted samples.
struct Planes {
    std::vector<std::vector<half>> halves;
    Imf::FrameBuffer buffer;
};

template <typename T>
Imf::Slice sliceOf(Imf::PixelType type, const T* values, int width) {
    // OpenEXR's interface takes no const; it only reads when writing a file
    auto* base = reinterpret_cast<char*>(const_cast<T*>(values));
    return {type, base, sizeof(T), sizeof(T) * static_cast<std::size_t>(width)};
}

void addHeader(const Frame& frame, Imf::Header& header) {
    for (const auto& [key, value] : frame.header)
        header.insert("penumbra." + key, Imf::StringAttribute(value));
    header.insert("penumbra.fingerprint", Imf::StringAttribute(frame.fingerprint));
    header.compression() = Imf::ZIP_COMPRESSION;
}

void addColour(const Frame& frame, Imf::Header& header, Planes& planes) {
    const char* names[] = {"R", "G", "B", "A"};
    const auto pixels = frame.rgba.size() / 4;
    for (std::size_t c = 0; c < 4; ++c) {
        auto& plane = planes.halves.emplace_back(pixels);
        for (std::size_t i = 0; i < pixels; ++i)
            plane[i] = half(std::min(frame.rgba[4 * i + c], 65504.0F));
        header.channels().insert(names[c], Imf::Channel(Imf::HALF));
        planes.buffer.insert(names[c], sliceOf(Imf::HALF, plane.data(), frame.width));
    }
}

void addChannels(const std::vector<Channel>& channels, int width, Imf::Header& header,
                 Planes& planes) {
    for (const auto& channel : channels) {
        const bool uints = !channel.ids.empty();
        header.channels().insert(channel.name, Imf::Channel(uints ? Imf::UINT : Imf::FLOAT));
        planes.buffer.insert(channel.name, uints
                                               ? sliceOf(Imf::UINT, channel.ids.data(), width)
                                               : sliceOf(Imf::FLOAT, channel.values.data(), width));
    }
}

/// What OpenEXR writes to. Its OutputFile keeps errors of its last writes to itself.
class Stream : public Imf::OStream {
  public:
    explicit Stream(runtime::WholeFile& file) : OStream(file.path().c_str()), file_(&file) {}
    void write(const char bytes[], int count) override {
        file_->write(bytes, static_cast<std::size_t>(count));
    }
    std::uint64_t tellp() override { return file_->position(); }
    void seekp(std::uint64_t position) override { file_->seek(position); }

  private:
    runtime::WholeFile* file_;
};

void writeFile(const std::string& path, const Imf::Header& header, const Planes& planes,
               int height) {
    runtime::WholeFile whole(path);
    try {
        Stream stream(whole);
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(planes.buffer);
        file.writePixels(height);
    } catch (const std::exception& error) {
        whole.check();  // names the reason in one line, without OpenEXR's words around it
        throw Error(fmt::format("{}: cannot be written: {}", path, error.what()));
    }
    whole.commit();
}

void writeFrame(const std::string& path, const Frame& frame) {
    Imf::Header header(frame.width, frame.height);
    addHeader(frame, header);
    Planes planes;
    planes.halves.reserve(4);
    addColour(frame, header, planes);
    addChannels(frame.channels, frame.width, header, planes);
    writeFile(path, header, planes, frame.height);
}

void writeDepthMaps(const std::string& path, const Frame& frame) {
    Imf::Header header(frame.depthMapSize, frame.depthMapSize);
    addHeader(frame, header);
    Planes planes;
    addChannels(frame.depthMaps, frame.depthMapSize, header, planes);
    writeFile(path, header, planes, frame.depthMapSize);
}

void writeMasks(const std::string& path, const Frame& frame) {
    Imf::Header header(frame.maskWidth, frame.maskHeight);
    addHeader(frame, header);
    for (const auto& [light, cells] : frame.maskCells)
        header.insert("penumbra.mask." + light, Imf::StringAttribute(cells));
    Planes planes;
    addChannels(frame.masks, frame.maskWidth, header, planes);
    writeFile(path, header, planes, frame.maskHeight);
}

/// OpenEXR takes as much memory as an attribute says that it has bytes, 2 GiB at most, before it
/// reads them. Looks at the first header alone: that of the part that is read.
void checkAttributes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::uint64_t fileBytes = std::filesystem::file_size(path);
    std::string name, type;
    file.ignore(8);  // magic number and version
    while (std::getline(file, name, '\0') && !name.empty() && std::getline(file, type, '\0')) {
        unsigned char size[4] = {};
        if (!file.read(reinterpret_cast<char*>(size), sizeof size)) return;
        const std::uint64_t bytes =
            size[0] | size[1] << 8U | size[2] << 16U | static_cast<std::uint64_t>(size[3]) << 24U;
        require(bytes <= fileBytes, "attribute '{}' has {} bytes in a file of {}", name, bytes,
                fileBytes);
        file.ignore(static_cast<std::streamsize>(bytes));
    }
}

}  // namespace

void writeExrFile(const std::string& path, const Frame& frame) {
    // The frame itself comes last: where it is whole, so is what lies beside it
    if (!frame.depthMaps.empty()) writeDepthMaps(depthMapsPath(path), frame);
    if (!frame.masks.empty()) writeMasks(masksPath(path), frame);
    writeFrame(path, frame);
}

LoadedImage readExrFile(const std::string& path) try {
    checkAttributes(path);
    Imf::Header::setMaxImageSize(kMaxSide, kMaxSide);  // before it allocates lines of any width
    Imf::InputFile file(path.c_str());
    const auto& header = file.header();
    const auto window = header.dataWindow();
    LoadedImage image;
    // OpenEXR has checked that these differences fit
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    std::size_t channelCount = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) ++channelCount;
    requireReadable(image.width, image.height, channelCount);
    require(file.isComplete(), "its end is missing");
    const auto pixels =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        image.channels.push_back({c.name(), std::vector<float>(pixels), {}});
    Imf::FrameBuffer buffer;
    for (auto& channel : image.channels)
        buffer.insert(channel.name, Imf::Slice::Make(Imf::FLOAT, channel.values.data(), window));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    for (auto a = header.begin(); a != header.end(); ++a)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
            image.header.emplace_back(a.name(), text->value());
    return image;
} catch (const std::exception& error) {
    throw Error(fmt::format("{}: not a readable EXR file: {}", path, toOneLine(error.what())));
}

}  // namespace penumbra::image
