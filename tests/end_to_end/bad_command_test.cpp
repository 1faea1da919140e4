// SPDX-License-Identifier: MIT
// Options and image files that must be refused, each with its exit code and whole message.
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "host/penumbra.h"
#include "tests/support/command.h"
#include "tests/support/fixtures.h"
#include "tests/support/png_bytes.h"

namespace penumbra::tests {
namespace {

struct BadCommand {
    const char* name;
    const char* arguments;  ///< DIR stands for the folder of makeFiles
    int code;
    const char* message;
};

void write(const std::string& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

/// A black frame as an EXR file of ours.
void writeFrame(const std::string& path, int width, int height) {
    Frame frame;
    frame.width = width;
    frame.height = height;
    frame.rgba.assign(static_cast<std::size_t>(4 * width * height), 0.0F);
    writeExr(path, frame);
}

/// The same file, whose header tells another size.
std::string withSize(std::string exr, std::int32_t width, std::int32_t height) {
    const std::string attribute("dataWindow\0box2i\0\x10\0\0\0", 21);
    const std::int32_t last[] = {width - 1, height - 1};
    std::memcpy(&exr[exr.find(attribute) + attribute.size() + 8], last, sizeof last);
    return exr;
}

void makeFiles(const std::string& folder) {
    std::filesystem::create_directory(folder + "/folder.exr");
    writeFrame(folder + "/a.exr", 2, 2);
    writeFrame(folder + "/wide.exr", 3, 2);
    const std::string exr = readFile(folder + "/a.exr");
    write(folder + "/cut.exr", exr.substr(0, exr.size() - 5));
    write(folder + "/bomb.exr", withSize(exr, 40000, 2));
    std::string greedy = exr;
    greedy.replace(greedy.find("chlist") + 7, 4, "\xFF\xFF\xFF\x7F");
    write(folder + "/greedy.exr", greedy);
    write(folder + "/text.exr", "hello");
    write(folder + "/empty.png", "");
    write(folder + "/cut.png", pngBytes(2, 2).substr(0, 50));
    write(folder + "/bomb.png", pngBytes(16384, 16384));
    write(folder + "/few.png", pngBytes(1000, 1000));
    write(folder + "/unknown.toml", "colour = 3\n");
    write(folder + "/section.toml", "[render]\nsize = \"1x1\"\n");
    write(folder + "/flag.toml", "ground = maybe\n");
    write(folder + "/size.toml", "size = \"1x\"\n");
}

#define RENDER "render -o DIR/a.png --size 32x32 "

const BadCommand kBadCommands[] = {
    // Sizes and counts
    {"SizeBeyondAnInt", "render -o DIR/a.png --size 4294967297x32", 2,
     "--size '4294967297x32' is not WIDTHxHEIGHT in pixels"},
    {"SizeOfNothing", "render -o DIR/a.png --size 0x0", 2,
     "--size '0x0' is not WIDTHxHEIGHT in pixels"},
    {"SizeOfOneNumber", "render -o DIR/a.png --size 32", 2,
     "--size '32' is not WIDTHxHEIGHT in pixels"},
    {"SizeBeyondTheRasteriser", "render -o DIR/a.png --size 16385x1", 2,
     "--size 16385x1 is outside of 1x1 to 16384x16384 pixels"},
    {"SizeBeyondMemory", "render -o DIR/a.png --size 16384x16384", 4,
     "out of memory: 268 million pixels with supersampling, at most 90 million fit; "
     "use a smaller --size or --supersample"},
    {"NoLightSamples", RENDER "--light-samples 0", 2,
     "--light-samples '0' is not a number of samples; allowed: N or MxN, 1 to 4096 "
     "in all"},
    {"TooManyLightSamples", RENDER "--light-samples 5000", 2,
     "--light-samples 5000 is outside of 1 to 4096"},
    {"LightSamplesWhoseProductWraps", RENDER "--light-samples 65536x65536", 2,
     "--light-samples 65536x65536 has more than 4096 samples"},
    {"MemoryBelowNothing", RENDER "--memory -5", 2,
     "--memory: Value -5 not in range 0 to 1073741824; see penumbra render --help"},
    {"MemoryBeyondAnything", RENDER "--memory 99999999999999999999", 2,
     "--memory: Value 99999999999999999999 not in range 0 to 1073741824; see "
     "penumbra render --help"},
    {"SupersamplingBeyondItsRange", RENDER "--supersample 99", 2,
     "--supersample 99 is outside of 1 to 8"},
    // Frames and seeds
    {"FramesBackwards", RENDER "--frames 3..1", 2, "--frames '3..1': 3..1 runs backwards"},
    {"FrameBelowNothing", RENDER "--frames -1", 2,
     "--frames '-1': '-1' is not a frame; allowed: 1,3,5..10 or 0..119 or all, "
     "frames 0 to 1000000"},
    {"FrameBeyondTheLast", RENDER "--frames 1000001", 2,
     "--frames '1000001': '1000001' is not a frame; allowed: 1,3,5..10 or 0..119 or "
     "all, frames 0 to 1000000"},
    {"AllOfTooManyFrames", RENDER "--frames all --fps 1e300", 2,
     "--frames all are more than 1000000 frames; name some, as 0..119 does"},
    {"EndlessFramesPerSecond", RENDER "--fps inf", 2, "--fps inf is not a number greater than 0"},
    {"SeedBelowNothing", RENDER "--seed -1", 2,
     "--seed '-1' is neither a whole number from 0 to 4294967295 nor 'frame'"},
    {"SeedWithLetters", RENDER "--seed 12abc", 2,
     "--seed '12abc' is neither a whole number from 0 to 4294967295 nor 'frame'"},
    {"SeedBeyondItsBits", RENDER "--seed 4294967296", 2,
     "--seed '4294967296' is neither a whole number from 0 to 4294967295 nor 'frame'"},
    // Lights, cameras, settings
    {"LightTooFar", RENDER "--light 'rect:at=1e300,0,0'", 2,
     "--light: at=1e300,0,0 is not a list of numbers, up to 1000000000000, "
     "separated by ','"},
    {"LightAtItsAim", RENDER "--light 'rect:at=0,1,0;aim=0,1,0'", 2,
     "--light: at and aim are the same point"},
    {"LightOfNoNumber", RENDER "--light 'sphere:radius=nan'", 2,
     "--light: radius=nan is not a list of numbers, up to 1000000000000, separated "
     "by ','"},
    {"LightTwicePlaced", RENDER "--light 'rect:at=0,1,0;at=0,2,0'", 2,
     "--light: 'at' is given twice"},
    {"EyeTooFar", RENDER "--eye 1e300,0,0", 2,
     "--eye 1e+300,0,0 is outside of -1000000000000 to 1000000000000 m"},
    {"EyeThatIsNoNumber", RENDER "--eye nan,0,0", 2,
     "--eye nan,0,0 is outside of -1000000000000 to 1000000000000 m"},
    {"SettingWithoutValue", RENDER "--set vwss.pcf", 2,
     "--set 'vwss.pcf' is not technique.setting=value; see `penumbra techniques`"},
    {"SettingWithoutName", RENDER "--set vwss.=1", 2,
     "vwss has no setting ''; allowed: pcf, resolution, outside, halfResolution, "
     "depthBits, viewsPerBatch, skipLit, bias, constantBias, slopeBias, cull, "
     "density, precision, parallelism, viewsPerPass, buffered"},
    // Configuration files
    {"ConfigIsAFolder", RENDER "--config DIR", 1, "--config DIR: cannot be read"},
    {"ConfigOfAnUnknownOption", RENDER "--config DIR/unknown.toml", 2,
     "--config DIR/unknown.toml: 'colour' is not an option of render; see penumbra "
     "render --help"},
    {"ConfigWithASection", RENDER "--config DIR/section.toml", 2,
     "--config DIR/section.toml: 'render.size' is not an option of render; see "
     "penumbra render --help"},
    {"ConfigOfAFlagThatIsNeither", RENDER "--config DIR/flag.toml", 2,
     "--config DIR/flag.toml: ground is not true or false"},
    {"ConfigOfHalfASize", "render -o DIR/a.png --config DIR/size.toml", 2,
     "--size '1x' is not WIDTHxHEIGHT in pixels"},
    // Scenes and images
    {"SceneIsAFolder", RENDER "DIR", 1, "DIR: 'DIR' is not a regular file"},
    {"SceneIsADevice", RENDER "/dev/zero", 1, "/dev/zero: '/dev/zero' is not a regular file"},
    {"ReferenceIsAFolder",
     "compare --techniques none --size 32x32 --report DIR/r --reference DIR/folder.exr", 1,
     "DIR/folder.exr: is not a regular file"},
    {"ReferenceIsAbsent",
     "compare --techniques none --size 32x32 --report DIR/r --reference DIR/absent.exr", 1,
     "DIR/absent.exr: no such file"},
    {"ReferenceOfAnotherSize",
     "compare -q --techniques none --size 32x32 --report DIR/r --reference DIR/wide.exr", 1,
     "the reference has 3x2 pixels, the frames 32x32; use --size 3x2"},
    {"DiffOfAFolder", "diff DIR/folder.exr DIR/a.exr", 1, "DIR/folder.exr: is not a regular file"},
    {"DiffOfADevice", "diff /dev/zero DIR/a.exr", 1, "/dev/zero: is not a regular file"},
    {"DiffOfOtherSizes", "diff DIR/a.exr DIR/wide.exr", 1,
     "the images have 2x2 and 3x2 pixels; they must agree"},
    {"DiffOfAnExrCutOff", "diff DIR/cut.exr DIR/a.exr", 1,
     "DIR/cut.exr: not a readable EXR file: Error reading pixel data from image "
     R"(file "DIR/cut.exr". Early end of file: read 6 out of 11 requested bytes.)"},
    {"DiffOfAnExrBomb", "diff DIR/bomb.exr DIR/a.exr", 1,
     R"(DIR/bomb.exr: not a readable EXR file: Cannot read image file "DIR/bomb.exr". )"
     "The width of the data window exceeds the maximum width of 16384pixels."},
    {"DiffOfAnExrWithAGreedyAttribute", "diff DIR/greedy.exr DIR/a.exr", 1,
     "DIR/greedy.exr: not a readable EXR file: attribute 'channels' has 2147483647 bytes in a file "
     "of 390"},
    {"DiffOfText", "diff DIR/text.exr DIR/a.exr", 1,
     R"(DIR/text.exr: not a readable EXR file: Cannot read image file "DIR/text.exr". )"
     "Early end of file: read 1 out of 4 requested bytes."},
    {"DiffOfAnEmptyPng", "diff DIR/empty.png DIR/a.exr", 1,
     "DIR/empty.png: not a readable PNG file: it ends too early"},
    {"DiffOfAPngCutOff", "diff DIR/cut.png DIR/a.exr", 1,
     "DIR/cut.png: not a readable PNG file: it ends too early"},
    {"DiffOfAPngBomb", "diff DIR/bomb.png DIR/a.exr", 1,
     "DIR/bomb.png: not a readable PNG file: 16384 x 16384 pixels; allowed are 1 to "
     "16384 along a side and 90 million in all"},
    {"DiffOfAPngOfTooFewPixels", "diff DIR/few.png DIR/a.exr", 1,
     "DIR/few.png: not a readable PNG file: it has fewer pixels than its header "
     "tells"},
    {"DiffByAMaskOfAnotherSize", "diff DIR/a.exr DIR/a.exr --mask DIR/wide.exr", 1,
     "the mask has not the images' 2x2 pixels"},
    {"DiffOfALayerThatIsNotThere", "diff DIR/a.exr DIR/a.exr --layer Z", 1,
     "layer 'Z' is not in both images; both have: A, RGB"},
    {"ShareWithoutStep", "diff DIR/a.exr DIR/a.exr --fail-share 0.1x", 2,
     "--fail-share 0.1x is not STEP=SHARE; allowed steps: 1, 4, 16 (of 255)"},
};

std::string replaceFolder(std::string text, const std::string& folder) {
    for (auto at = text.find("DIR"); at != std::string::npos; at = text.find("DIR", at))
        text.replace(at, 3, folder);
    return text;
}

class BadCommandTest : public testing::TestWithParam<BadCommand> {
  protected:
    // Of this process: suites run side by side
    static void SetUpTestSuite() {
        folder = temporaryFolder("bad-command-" + std::to_string(getpid()));
        makeFiles(folder);
    }
    inline static std::string folder;
};

TEST_P(BadCommandTest, EndsWithItsCodeAndMessage) {
    const BadCommand& bad = GetParam();
    const auto result = run(replaceFolder(bad.arguments, folder));
    EXPECT_EQ(result.code, bad.code);
    EXPECT_EQ(result.errors, "penumbra: " + replaceFolder(bad.message, folder) + "\n");
    EXPECT_EQ(result.output, "");
}

INSTANTIATE_TEST_SUITE_P(All, BadCommandTest, testing::ValuesIn(kBadCommands),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace penumbra::tests
