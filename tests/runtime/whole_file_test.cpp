// SPDX-License-Identifier: MIT
// Files bear their name when they are whole, and only then.
#include "runtime/whole_file.h"

#include <filesystem>
#include <fstream>

#include "runtime/error.h"
#include "tests/support/fixtures.h"

namespace penumbra::tests {
namespace {

namespace fs = std::filesystem;
using runtime::WholeFile;

std::string contents(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t filesIn(const std::string& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

template <typename Call>
void expectError(const std::string& part, Call&& call) {
    try {
        call();
        FAIL() << "no error; expected: " << part;
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
}

TEST(WholeFileTest, AppearsUnderItsNameWhenCommittedAndLeavesNothingOtherwise) {
    const auto folder = temporaryFolder("whole-file");
    const auto path = folder + "/a.txt";
    {
        WholeFile file(path);
        file.write("lost", 4);
    }
    EXPECT_EQ(filesIn(folder), 0U);
    std::ofstream(path) << "before";
    {
        WholeFile file(path);
        file.write("abcd", 4);
        file.seek(1);
        EXPECT_EQ(file.position(), 1U);
        file.write("X", 1);
        EXPECT_EQ(contents(path), "before");
        file.commit();
        EXPECT_EQ(contents(path), "aXcd");
    }
    EXPECT_EQ(contents(path), "aXcd");
    EXPECT_EQ(filesIn(folder), 1U);
}

TEST(WholeFileTest, WritersOfTheSameNameDoNotMix) {
    const auto path = temporaryFolder("whole-file-two") + "/a.txt";
    WholeFile first(path), second(path);
    first.write("first", 5);
    second.write("2", 1);
    first.commit();
    EXPECT_EQ(contents(path), "first");
    second.commit();
    EXPECT_EQ(contents(path), "2");
}

TEST(WholeFileTest, AFullDiskIsAnErrorEvenWhereACallerSwallowsIt) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
    const std::string reason = "/dev/full: cannot be written: No space left on device";
    WholeFile buffered("/dev/full");
    buffered.write("a", 1);
    expectError(reason, [&] { buffered.commit(); });
    WholeFile large("/dev/full");
    const std::string bytes(1 << 20, 'x');
    EXPECT_THROW(large.write(bytes.data(), bytes.size()), Error);
    expectError(reason, [&] { large.commit(); });
}

TEST(WholeFileTest, WhatCannotBeAFileIsRefusedBeforeAnythingIsWritten) {
    const auto folder = temporaryFolder("whole-file-bad");
    expectError(": cannot be written: Is a directory", [&] { WholeFile file(folder); });
    expectError(": cannot be written: No such file", [&] { WholeFile file(folder + "/b/a.txt"); });
    std::ofstream(folder + "/file") << "x";
    expectError(": cannot be written: Not a dir", [&] { WholeFile file(folder + "/file/a.txt"); });
}

TEST(WholeFileTest, WhatKilledProcessesLeaveIsRemovedAndWhatIsBeingWrittenStays) {
    const auto folder = temporaryFolder("abandoned");
    const std::string strangers[] = {"b.exr.12-0.tmp", "a.exr.tmp", "a.exr.new.tmp",
                                     "a.exr..tmp",     "a.exr",     ".tmp"};
    for (const auto& name : strangers) std::ofstream(folder + "/" + name) << "x";
    for (const char* name : {"a.exr.12-0.tmp", "a.exr.7-3.tmp"})
        std::ofstream(folder + "/" + name) << "x";
    WholeFile live(folder + "/a.exr");
    live.write("whole", 5);
    EXPECT_EQ(runtime::removeAbandoned(folder, {"a.exr", "c.exr"}), 2);
    live.commit();
    EXPECT_EQ(contents(folder + "/a.exr"), "whole");
    for (const auto& name : strangers) EXPECT_TRUE(fs::exists(folder + "/" + name)) << name;
    EXPECT_EQ(filesIn(folder), std::size(strangers));
    EXPECT_EQ(runtime::removeAbandoned(folder + "/absent", {"a.exr"}), 0);
}

}  // namespace
}  // namespace penumbra::tests
