// SPDX-License-Identifier: MIT
#include "host/app/frame_list.h"

#include <gtest/gtest.h>

#include "runtime/error.h"

namespace penumbra::app {
namespace {

using Frames = std::vector<int>;

TEST(FrameListTest, ListsRangesAndAllAsBlenderWritesThem) {
    EXPECT_EQ(parseFrames("0", 10), Frames{0});
    EXPECT_EQ(parseFrames("1,3,5..8", 10), (Frames{1, 3, 5, 6, 7, 8}));
    EXPECT_EQ(parseFrames("5..6,1,5", 10), (Frames{1, 5, 6}));
    EXPECT_EQ(parseFrames("all", 3), (Frames{0, 1, 2}));
}

TEST(FrameListTest, AnythingElseIsAUsageError) {
    for (const char* text :
         {"", "a", "1,", "3..1", "1..", "..3", "-1", "1.5", "1...3", "9999999", "99999999999999"}) {
        try {
            parseFrames(text, 10);
            ADD_FAILURE() << "'" << text << "' is taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::usage);
        }
    }
}

TEST(FramePathTest, TheLastRunOfHashesIsTheNumber) {
    EXPECT_EQ(framePath("out/f_####.png", 7), "out/f_0007.png");
    EXPECT_EQ(framePath("a#/f_#.png", 123), "a#/f_123.png");
    EXPECT_EQ(framePath("one.png", 3), "one.png");
    EXPECT_FALSE(hasFrameNumber("one.png"));
}

}  // namespace
}  // namespace penumbra::app
