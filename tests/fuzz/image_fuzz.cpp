// SPDX-License-Identifier: MIT
// Bytes of an EXR or PNG file -> planes -> the figures of `penumbra diff` of the file and itself.
#include <cstring>

#include "host/image/image_file.h"
#include "host/metrics/image_error.h"
#include "tests/fuzz/expect_one_line.h"

namespace penumbra::fuzz {
namespace {

constexpr std::uint64_t kMaxCompared = 64;  // pixels: FLIP is slow

void compare(const std::uint8_t* bytes, std::size_t size) {
    const MemoryFile file(bytes, size);
    const bool png = size > 0 && bytes[0] == 0x89;
    const auto image = png ? image::readPngFile(file.path()) : image::readExrFile(file.path());
    const auto pixels =
        static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height);
    for (const auto& channel : image.channels)
        expect(channel.values.size() == pixels, "planes of the image's size");
    if (pixels > kMaxCompared) return;
    for (const auto& error : metrics::compareImages(image, image, "", {}, {67}))
        expect(error.error.maximum == 0 || error.error.maximum == 1, "no difference but NaN's");
}

}  // namespace
}  // namespace penumbra::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    penumbra::fuzz::expectOneLine([&] { penumbra::fuzz::compare(bytes, size); });
    return 0;
}
