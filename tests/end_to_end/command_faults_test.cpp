// SPDX-License-Identifier: MIT
// The command where the machine fails it: one clear line, its exit code, and nothing lost that was
// whole. tools/check_resume kills it at random, and many times.
#include <fmt/format.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "host/penumbra.h"
#include "tests/support/command.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

namespace fs = std::filesystem;
const std::string kSmall = "render --size 64x36 --light-samples 4 --set vwss.resolution=128 -q ";

std::vector<std::string> filesIn(const std::string& folder) {
    std::vector<std::string> names;
    for (const auto& file : fs::directory_iterator(folder))
        names.push_back(file.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

void expectLine(const Result& result, int code, const std::string& part) {
    EXPECT_EQ(result.code, code) << result.errors;
    EXPECT_NE(result.errors.find(part), std::string::npos) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
}

/// A variable of the command's environment.
class Variable {
  public:
    Variable(const char* name, const std::string& value) : name_(name) {
        setenv(name, value.c_str(), 1);
    }
    ~Variable() { unsetenv(name_); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

  private:
    const char* name_;
};

/// Runs the command where no file may have more bytes.
Result runLimited(const std::string& arguments, rlim_t bytes) {
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    auto result = run(arguments);
    setrlimit(RLIMIT_FSIZE, &before);
    return result;
}

/// Starts the command with these arguments in the background. No shell: its number is the one to
/// kill.
pid_t start(const std::vector<std::string>& arguments) {
    const pid_t child = fork();
    if (child != 0) return child;
    std::vector<char*> pointers;
    std::string name = PENUMBRA_COMMAND;
    pointers.push_back(name.data());
    auto copies = arguments;
    for (auto& argument : copies) pointers.push_back(argument.data());
    pointers.push_back(nullptr);
    execv(name.c_str(), pointers.data());
    _exit(127);
}

void waitFor(const std::string& path) {
    for (int i = 0; i < 1000 && !fs::exists(path); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ASSERT_TRUE(fs::exists(path));
}

TEST(CommandFaultsTest, KilledRunsResumeToTheSameFolder) {
    const auto truth = temporaryFolder("undisturbed"), folder = temporaryFolder("killed");
    const std::vector<std::string> arguments{
        "render",   "-q",         "--size",   "64x36", "--light-samples",
        "4",        "--temporal", "3",        "--set", "vwss.resolution=128",
        "--frames", "0..11",      "--resume", "-o"};
    const auto command = kSmall + "--temporal 3 --resume --frames 0..11 -o ";
    ASSERT_EQ(run(command + truth + "/f_##.exr").code, 0);
    for (const char* until : {"f_01.exr", "f_05.exr"}) {
        auto started = arguments;
        started.push_back(folder + "/f_##.exr");
        const pid_t child = start(started);
        waitFor(folder + "/" + until);
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        for (const auto& name : filesIn(folder)) {
            if (!name.ends_with(".exr")) continue;
            EXPECT_EQ(readFile(folder + "/" + name), readFile(truth + "/" + name)) << name;
        }
    }
    // As a process that was killed in the middle of a write leaves it
    std::ofstream(folder + "/f_07.exr.1-0.tmp") << "half";
    ASSERT_EQ(run(command + folder + "/f_##.exr").code, 0);
    ASSERT_EQ(filesIn(folder), filesIn(truth));
    for (const auto& name : filesIn(truth))
        EXPECT_EQ(readFile(folder + "/" + name), readFile(truth + "/" + name)) << name;
}

TEST(CommandFaultsTest, AFileTooLargeIsAnErrorThatLeavesNothing) {
    const auto folder = temporaryFolder("too-large");
    const auto frames = "render -q --size 960x540 --technique none --aov all --frames 0..1 -o ";
    ASSERT_EQ(run(frames + temporaryFolder("large") + "/a_#.exr").code, 0);  // compiles kernels
    // The driver's own files stay below
    expectLine(runLimited(frames + folder + "/a_#.exr", 1536 << 10), 1, "File too large; 0 of 2");
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(CommandFaultsTest, AFullDiskKeepsWhatWasWhole) {
    const auto folder = temporaryFolder("full-disk");
    if (mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=16k") != 0)
        GTEST_SKIP() << "this user may not mount a small disk";
    const auto result = run(kSmall + "--frames 0..9 -o " + folder + "/f_#.exr");
    const auto names = filesIn(folder);
    const auto first = readFile(folder + "/f_0.exr");
    umount(folder.c_str());
    expectLine(result, 1, "cannot be written: No space left on device; 1 of 10 frames are whole");
    EXPECT_EQ(names, std::vector<std::string>{"f_0.exr"});
    ASSERT_EQ(run(kSmall + "-o " + folder + "/f_0.exr").code, 0);
    EXPECT_EQ(first, readFile(folder + "/f_0.exr"));
}

TEST(CommandFaultsTest, AReadOnlyFolderIsRefusedBeforeTheFirstFrame) {
    const auto folder = temporaryFolder("read-only");
    if (mount("tmpfs", folder.c_str(), "tmpfs", MS_RDONLY, nullptr) != 0)
        GTEST_SKIP() << "this user may not mount a read-only disk";
    const auto file = run(kSmall + "-o " + folder + "/a.png");
    const auto subfolder = run(kSmall + "-o " + folder + "/b/a.png");
    umount(folder.c_str());
    expectLine(file, 1, "the folder " + folder + " cannot be written: Read-only");
    expectLine(subfolder, 1, "cannot be made: Read-only");
}

TEST(CommandFaultsTest, WhatIsNoFolderOrNoFileIsNamed) {
    const auto folder = temporaryFolder("not-a-folder");
    std::ofstream(folder + "/file") << "x";
    fs::create_directory(folder + "/a.png");
    expectLine(run(kSmall + "-o " + folder + "/file/a.png"), 1, "Not a directory");
    expectLine(run(kSmall + "-o " + folder + "/a.png"), 1, "a.png is a folder");
}

TEST(CommandFaultsTest, AFolderThatGoesAwayEndsTheSequence) {
    const auto folder = temporaryFolder("gone");
    const auto log = temporaryFolder("gone-log") + "/log";
    const auto line = "sh -c '" + std::string(PENUMBRA_COMMAND) + " " + kSmall +
                      "--frames 0..5000 -o " + folder + "/f_####.png 2>" + log +
                      " & while ! [ -e " + folder + "/f_0001.png ]; do sleep 0.02; done; mv " +
                      folder + " " + folder + "-moved; wait $!'";
    fs::remove_all(folder + "-moved");
    EXPECT_EQ(WEXITSTATUS(std::system(line.c_str())), 1);
    EXPECT_NE(readFile(log).find("cannot be written: No such file"), std::string::npos)
        << readFile(log);
    for (const auto& name : filesIn(folder + "-moved")) {
        if (!name.ends_with(".png")) continue;
        EXPECT_NE(readFingerprint(folder + "-moved/" + name), "") << name;
    }
}

TEST(CommandFaultsTest, ADeviceLostInTheMiddleKeepsWhatWasWhole) {
#ifdef PENUMBRA_LOST_DEVICE
    const auto folder = temporaryFolder("lost");
    const auto frames = kSmall + "--frames 0..9 --resume -o " + folder + "/f_#.png";
    {
        const Variable preload("LD_PRELOAD", PENUMBRA_LOST_DEVICE), after("LOSE_AFTER", "1");
        expectLine(run(frames), 3, "was lost");
    }
    EXPECT_TRUE(fs::is_empty(folder));
    {
        const Variable preload("LD_PRELOAD", PENUMBRA_LOST_DEVICE), after("LOSE_AFTER", "100");
        const auto result = run(frames);
        const auto names = filesIn(folder);
        EXPECT_GT(names.size(), 0U);
        EXPECT_LT(names.size(), 10U);
        expectLine(result, 3, fmt::format("{} of 10 frames are whole, --resume", names.size()));
        for (const auto& name : names) EXPECT_NE(readFingerprint(folder + "/" + name), "") << name;
    }
    EXPECT_EQ(run(frames).code, 0);
    EXPECT_EQ(filesIn(folder).size(), 10U);
#else
    GTEST_SKIP() << "sanitizers do not allow it";
#endif
}

TEST(CommandFaultsTest, WithoutACacheFolderThereIsADeviceAllTheSame) {
    const auto file = temporaryFolder("no-cache") + "/file";
    std::ofstream(file) << "x";
    const Variable cache("POCL_CACHE_DIR", file + "/cache");
    const auto result = run("devices --json");
    EXPECT_EQ(result.code, 0) << result.errors;
    EXPECT_FALSE(nlohmann::json::parse(result.output)["devices"].empty());
}

}  // namespace
}  // namespace penumbra::tests
