// SPDX-License-Identifier: MIT
// The command as a user runs it: files, exit codes, messages.
#include "tests/support/command.h"

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "host/image/image_file.h"
#include "runtime/error.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

const std::string kSmall = "render --size 64x36 --light-samples 4 --set vwss.resolution=128 -q ";

TEST(CommandTest, ASequenceIsWrittenAndTheSameBytesTwice) {
    const auto folder = temporaryFolder("sequence");
    ASSERT_EQ(run(kSmall + "--frames 0..2 --aov all -o " + folder + "/a_####.exr").code, 0);
    ASSERT_EQ(run(kSmall + "--frames 0..2 --aov all -o " + folder + "/b_####.exr").code, 0);
    for (const char* frame : {"0000", "0001", "0002"})
        EXPECT_EQ(readFile(folder + "/a_" + frame + ".exr"),
                  readFile(folder + "/b_" + frame + ".exr"));
    EXPECT_NE(readFile(folder + "/a_0000.exr"), readFile(folder + "/a_0002.exr"));
}

TEST(CommandTest, AFrameDoesNotDependOnWhichOthersWereAskedFor) {
    const auto folder = temporaryFolder("alone");
    for (const char* extra : {"", "--temporal 3 --seed frame "}) {
        ASSERT_EQ(run(kSmall + extra + "--frames 4..6 -o " + folder + "/a_#.exr").code, 0);
        ASSERT_EQ(run(kSmall + extra + "--frames 6 -o " + folder + "/b_#.exr").code, 0);
        EXPECT_EQ(readFile(folder + "/a_6.exr"), readFile(folder + "/b_6.exr")) << extra;
    }
}

TEST(CommandTest, ResumeSkipsWholeFramesAndRendersTheRest) {
    const auto folder = temporaryFolder("resume");
    const auto command = kSmall + "--resume -o " + folder + "/f_#.png --frames ";
    ASSERT_EQ(run(command + "0..2").code, 0);
    const auto whole = readFile(folder + "/f_1.png");
    std::filesystem::resize_file(folder + "/f_1.png", whole.size() / 2);
    std::filesystem::remove(folder + "/f_2.png");
    const auto first = std::filesystem::last_write_time(folder + "/f_0.png");
    ASSERT_EQ(run(command + "0..2").code, 0);
    EXPECT_EQ(readFile(folder + "/f_1.png"), whole);
    EXPECT_TRUE(std::filesystem::exists(folder + "/f_2.png"));
    EXPECT_EQ(std::filesystem::last_write_time(folder + "/f_0.png"), first);
    // Other settings have another fingerprint
    ASSERT_EQ(run(command + "0 --set vwss.pcf=1").code, 0);
    EXPECT_NE(std::filesystem::last_write_time(folder + "/f_0.png"), first);
}

TEST(CommandTest, StatsTellStagesProgramsAndMemory) {
    const auto folder = temporaryFolder("stats");
    ASSERT_EQ(run(kSmall + "-o " + folder + "/a.png --stats " + folder + "/s.json").code, 0);
    const auto stats = nlohmann::json::parse(readFile(folder + "/s.json"));
    EXPECT_EQ(stats["schema"], 1);
    EXPECT_GT(stats["memory"]["peak"].get<double>(), 1e5);
    const auto& frame = stats["frames"].at(0);
    EXPECT_GT(frame["points"].get<int>(), 100);
    double points = 0;
    for (const auto& stage : frame["stages"])
        if (stage["name"] == "points") points = stage["deviceMs"].get<double>();
    EXPECT_GT(points, 0);
}

TEST(CommandTest, DiffComparesAndFailsBeyondItsLimits) {
    const auto folder = temporaryFolder("diff");
    ASSERT_EQ(run(kSmall + "--aov visibility -o " + folder + "/a.exr").code, 0);
    ASSERT_EQ(run(kSmall + "--aov visibility --set vwss.pcf=9 -o " + folder + "/b.exr").code, 0);
    const std::string files = folder + "/a.exr " + folder + "/b.exr ";
    const auto result = run("diff --json " + files);
    EXPECT_EQ(result.code, 0);
    const auto json = nlohmann::json::parse(result.output);
    EXPECT_EQ(json["layer"], "visibility.key");
    EXPECT_GT(json["rmse"].get<double>(), 0);
    EXPECT_EQ(run("diff " + files + "--fail-rmse 1e-9").code, 5);
    EXPECT_EQ(run("diff " + files + "--fail-share 1=0").code, 5);
    EXPECT_EQ(run("diff " + files + "--fail-share 3=0").code, 2);
    EXPECT_EQ(run("diff " + folder + "/a.exr " + folder + "/a.exr --fail-max 0").code, 0);
    EXPECT_EQ(run("diff " + folder + "/a.exr " + folder + "/absent.exr").code, 1);
}

/// A frame of soft stripes, `shift` pixels to the right, at `brightness`, as EXR and PNG files.
void writeStripes(const std::string& path, int shift, float brightness, double gain) {
    Frame frame;
    frame.width = 48;
    frame.height = 32;
    frame.exposure = gain;
    frame.header = {{"gain", fmt::format("{}", gain)}};
    Channel visibility{"visibility.key.R", {}, {}}, depth{"Z", {}, {}};
    for (int i = 0; i < frame.width * frame.height; ++i) {
        const auto wave = std::sin(0.3F * static_cast<float>(i % frame.width - shift));
        const float value = 0.5F + 0.5F * wave;
        for (const float c : {brightness * value, 0.5F * brightness, brightness, 1.0F})
            frame.rgba.push_back(c);
        visibility.values.push_back(value);
        depth.values.push_back(value);
    }
    writePng(path + ".png", frame);
    frame.channels = {depth};
    writeExr(path + "-rgb.exr", frame);
    frame.channels.push_back(visibility);
    writeExr(path + ".exr", frame);
}

nlohmann::json diffJson(const std::string& arguments) {
    const auto result = run("diff --json " + arguments);
    EXPECT_EQ(result.code, 0) << arguments << result.errors;
    return nlohmann::json::parse(result.output);
}

TEST(CommandTest, DiffTellsSsimAndFlipAndFailsBeyondTheirLimits) {
    const auto folder = temporaryFolder("diff-seen");
    writeStripes(folder + "/a", 0, 0.6F, 1);
    writeStripes(folder + "/b", 3, 0.6F, 1);
    for (const std::string end : {".exr ", "-rgb.exr ", ".png "}) {
        const auto a = folder + "/a" + end, b = folder + "/b" + end;
        const auto same = diffJson(a + a), other = diffJson(a + b);
        EXPECT_EQ(same["ssim"], 1) << end;
        EXPECT_EQ(same["flip"], 0) << end;
        const double ssim = other["ssim"], flip = other["flip"];
        EXPECT_LT(ssim, 0.95) << end;
        EXPECT_GT(flip, 0.05) << end;
        const auto code = [&](const char* option, double limit) {
            return run("diff " + a + b + fmt::format("{} {:.12f}", option, limit)).code;
        };
        EXPECT_EQ(code("--fail-ssim", ssim - 1e-6), 0) << end;
        EXPECT_EQ(code("--fail-ssim", ssim + 1e-6), 5) << end;
        EXPECT_EQ(code("--fail-flip", flip + 1e-6), 0) << end;
        EXPECT_EQ(code("--fail-flip", flip - 1e-6), 5) << end;
    }
    const auto far = diffJson(folder + "/a.png " + folder + "/b.png --pixels-per-degree 300");
    EXPECT_LT(far["flip"], diffJson(folder + "/a.png " + folder + "/b.png")["flip"]);
    const auto text = run("diff " + folder + "/a.png " + folder + "/b.png").output;
    EXPECT_NE(text.find("ssim 0."), std::string::npos) << text;
    EXPECT_NE(text.find("flip 0."), std::string::npos) << text;
}

TEST(CommandTest, DiffShowsColoursOfExrFilesAsPngFilesShowThem) {
    const auto folder = temporaryFolder("diff-shown");
    // Bright enough for the tone curve, and a gain that the header tells
    writeStripes(folder + "/a", 0, 6, 0.25);
    writeStripes(folder + "/b", 3, 6, 0.25);
    const auto exr = diffJson(folder + "/a-rgb.exr " + folder + "/b-rgb.exr");
    const auto png = diffJson(folder + "/a.png " + folder + "/b.png");
    EXPECT_NEAR(exr["flip"].get<double>(), png["flip"].get<double>(), 0.003);
    EXPECT_NEAR(exr["ssim"].get<double>(), png["ssim"].get<double>(), 0.003);
    EXPECT_NE(exr["rmse"], png["rmse"]);
    // The frame as a PNG file and as an EXR file differ by the rounding to bytes
    EXPECT_LT(diffJson(folder + "/a-rgb.exr " + folder + "/a.png")["flip"], 0.01);
}

TEST(CommandTest, DiffHasNoSsimAndFlipOfWhatIsNoPicture) {
    const auto folder = temporaryFolder("diff-depth");
    writeStripes(folder + "/a", 0, 0.6F, 1);
    const auto files = folder + "/a.exr " + folder + "/a.exr --layer Z ";
    EXPECT_TRUE(diffJson(files)["flip"].is_null());
    EXPECT_TRUE(diffJson(files)["ssim"].is_null());
    EXPECT_EQ(run("diff " + files + "--fail-rmse 1").code, 0);
    for (const char* limit : {"--fail-flip 1", "--fail-ssim 0"}) {
        const auto result = run("diff " + files + limit);
        EXPECT_EQ(result.code, 2);
        EXPECT_NE(result.errors.find("'Z' is no picture"), std::string::npos) << result.errors;
    }
}

TEST(CommandTest, RenderedFilesTellTheGainThatDiffShowsThemWith) {
    const auto folder = temporaryFolder("gain");
    ASSERT_EQ(run(kSmall + "--exposure -2 -o " + folder + "/a.exr").code, 0);
    const auto image = image::readImage(folder + "/a.exr");
    std::map<std::string, std::string> header(image.header.begin(), image.header.end());
    EXPECT_EQ(header["penumbra.gain"], "0.25");
}

TEST(CommandTest, ConfigurationFilesHoldOptionsAndTheCommandLineWins) {
    const auto folder = temporaryFolder("config");
    std::ofstream(folder + "/c.toml")
        << "size = \"48x32\"\nlight-samples = \"2\"\nset = [\"vwss.resolution=64\"]\n";
    ASSERT_EQ(run("render -q --config " + folder + "/c.toml -o " + folder + "/a.exr").code, 0);
    EXPECT_EQ(image::readImage(folder + "/a.exr").width, 48);
    ASSERT_EQ(run("render -q --config " + folder + "/c.toml --size 32x16 --set vwss.pcf=9 -o " +
                  folder + "/b.exr")
                  .code,
              0);
    const auto both = image::readImage(folder + "/b.exr");
    EXPECT_EQ(both.width, 32);
    // Settings of the file and of the command line add up
    std::map<std::string, std::string> header(both.header.begin(), both.header.end());
    EXPECT_EQ(header["penumbra.vwss.resolution"], "64");
    EXPECT_EQ(header["penumbra.vwss.pcf"], "9");
}

TEST(CommandTest, AnInterruptFinishesTheFrameAndResumeTheRest) {
    const auto folder = temporaryFolder("interrupt");
    const auto command = kSmall + "--resume -o " + folder + "/f_####.png --frames 0..";
    const std::string line = "timeout --preserve-status -s INT 1 " + std::string(PENUMBRA_COMMAND) +
                             " " + command + "5000 2>/dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 130);
    int files = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder)) {
        EXPECT_NE(readFingerprint(file.path().string()), "") << file.path();
        ++files;
    }
    ASSERT_LT(files, 5001);
    ASSERT_EQ(run(command + std::to_string(files + 1)).code, 0);
    for (int f = 0; f <= files + 1; ++f)
        EXPECT_TRUE(std::filesystem::exists(fmt::format("{}/f_{:04}.png", folder, f)));
}

TEST(CommandTest, SupersamplingSmoothsEdgesAndKeepsTheSize) {
    const auto folder = temporaryFolder("supersample");
    ASSERT_EQ(run(kSmall + "--supersample 2 --aov id,depth -o " + folder + "/a.exr").code, 0);
    const auto image = image::readImage(folder + "/a.exr");
    EXPECT_EQ(image.width, 64);
    const auto& alpha = *image.find("A");
    EXPECT_GT(std::count_if(alpha.begin(), alpha.end(), [](float a) { return a > 0 && a < 1; }),
              10);
    const auto& ids = *image.find("id.object");
    for (const float id : ids) EXPECT_EQ(id, std::floor(id));  // picked, not averaged
}

TEST(CommandTest, WithoutAnyDriverTheExitCodeIsThreeAndSaysWhereToLook) {
    const auto folder = temporaryFolder("no-drivers");
    setenv("OCL_ICD_VENDORS", folder.c_str(), 1);
    const auto result = run("render -o " + folder + "/a.png");
    unsetenv("OCL_ICD_VENDORS");
    EXPECT_EQ(result.code, 3);
    EXPECT_NE(result.errors.find(folder), std::string::npos) << result.errors;
}

TEST(CommandTest, RepeatedOptionsDoNotSwallowTheScene) {
    const auto folder = temporaryFolder("order");
    const auto result =
        run("render --set vwss.pcf=9 absent.glb --aov depth -o " + folder + "/a.exr");
    EXPECT_EQ(result.code, 1);
    EXPECT_NE(result.errors.find("absent.glb"), std::string::npos) << result.errors;
}

TEST(CommandTest, ALightAtTheCentreOfTheSceneGivesFiniteColours) {
    const auto folder = temporaryFolder("centre");
    const std::string light = "--light 'disk:at=0,0.95,0;aim=1,0,0;radius=0.1' ";
    ASSERT_EQ(run(kSmall + light + "-o " + folder + "/a.exr").code, 0);
    const auto image = image::readImage(folder + "/a.exr");
    for (const char* channel : {"R", "G", "B"})
        for (const float value : *image.find(channel)) ASSERT_TRUE(std::isfinite(value));
}

TEST(CommandTest, ListsAreJsonOnRequest) {
    EXPECT_FALSE(nlohmann::json::parse(run("devices --json").output)["devices"].empty());
    EXPECT_EQ(nlohmann::json::parse(run("techniques --json").output)["techniques"][0]["name"],
              "vwss");
    EXPECT_GT(nlohmann::json::parse(run("info --json").output)["trianglesDrawn"].get<int>(), 50000);
    EXPECT_EQ(run("info").code, 0);
    EXPECT_EQ(run("techniques").code, 0);
    EXPECT_EQ(run("devices -v").code, 0);
}

struct BadUse {
    const char* arguments;
    int code;
    const char* part;
};

class CommandErrorTest : public testing::TestWithParam<BadUse> {};

TEST_P(CommandErrorTest, EndsWithOneLineAndItsExitCode) {
    const auto& bad = GetParam();
    // OUT stands for a folder of this process: suites run side by side
    std::string arguments = bad.arguments;
    const std::string folder = temporaryFolder("bad-use-" + std::to_string(getpid()));
    for (auto at = arguments.find("OUT/"); at != std::string::npos;
         at = arguments.find("OUT/", at + folder.size()))
        arguments.replace(at, 3, folder);
    const auto result = run(arguments);
    EXPECT_EQ(result.code, bad.code) << result.errors;
    EXPECT_NE(result.errors.find(bad.part), std::string::npos) << result.errors;
    EXPECT_EQ(result.output, "");
}

INSTANTIATE_TEST_SUITE_P(
    All, CommandErrorTest,
    testing::Values(BadUse{"", 2, "no command is given"},
                    BadUse{"frobnicate", 2, "'frobnicate' is not a command"},
                    BadUse{"render -o OUT/a.png --exposure nan", 2, "--exposure"},
                    BadUse{"render -o OUT/a.png --light 'rect:radiance=-3'", 2, "at least 0"},
                    BadUse{"render -o OUT/a.png --light-samples 8x8 --light-pattern poisson", 2,
                           "allowed: grid"},
                    BadUse{"render -o OUT/a.png --technique mvr --light-pattern random", 2,
                           "only technique raytrace"},
                    BadUse{"render -o OUT/a.png --config /etc", 1, "cannot be read"},
                    BadUse{"render -o OUT/a.png --stats /absent/s.json", 1, "--stats"},
                    BadUse{"render", 2, "--output"},
                    BadUse{"render -o OUT/a.jpg", 2, ".exr nor .png"},
                    BadUse{"render -o OUT/a.png --frames 0..3", 2, "####"},
                    BadUse{"render -o OUT/a.png --frames 3..1", 2, "backwards"},
                    BadUse{"render absent.glb -o OUT/a.png", 1, "absent.glb"},
                    BadUse{"render -o OUT/a.png --technique magic", 2, "allowed: vwss"},
                    BadUse{"render -o OUT/a.png --set vwss.pcf=7", 2, "1, 5, 9, bilinear"},
                    BadUse{"render -o OUT/a.png --set vwss.resolution=9", 2, "64 to 8192"},
                    BadUse{"render -o OUT/a.png --set vwss.colour=9", 2, "no setting 'colour'"},
                    BadUse{"render -o OUT/a.png --light-samples 5000", 2, "4096"},
                    BadUse{"render -o OUT/a.png --light-samples 0", 2, "allowed: N or MxN"},
                    BadUse{"render -o OUT/a.png --light cone:", 2, "allowed: rect:"},
                    BadUse{"render -o OUT/a.png --light 'rect:size=1'", 2, "WxH"},
                    BadUse{"render -o OUT/a.png --size 0x5", 2, "--size"},
                    BadUse{"render -o OUT/a.png --aov depth", 2, "EXR"},
                    BadUse{"render -o OUT/a.exr --aov colour", 2, "allowed: all"},
                    BadUse{"render -o OUT/a.exr --aov depth-maps --technique raytrace", 2,
                           "raytrace makes none"},
                    BadUse{"render -o OUT/a.exr --aov mask --technique vwss", 2,
                           "vwss makes no occlusion masks"},
                    BadUse{"render -o OUT/a.exr --technique raster4d --light-samples 128x4", 2,
                           "at most 64x64"},
                    BadUse{"render -o OUT/a.png --camera absent", 2, "allowed: auto"},
                    BadUse{"render -o OUT/a.png --device absent", 3, "no OpenCL device matches"},
                    BadUse{"render -o OUT/a.png --memory 20", 4, "out of memory"},
                    BadUse{"render -o /proc/penumbra/a.png", 1, "cannot be made"},
                    BadUse{"diff a.png b.png --fail-flip nan", 2, "outside of 0 to 1"},
                    BadUse{"diff a.png b.png --fail-ssim 1.5", 2, "outside of -1 to 1"},
                    BadUse{"diff a.png b.png --pixels-per-degree 0", 2, "outside of 1 to 1000"}));

}  // namespace
}  // namespace penumbra::tests
