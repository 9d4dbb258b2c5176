// SPDX-License-Identifier: Apache-2.0
#include "touch/live_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace knead::tools::test {
namespace {

using ::testing::HasSubstr;

LiveFrame frame(HapticMode mode) {
    LiveFrame frame;
    frame.title = "a very long name of a scene and a level, tool with a long name, a hand on phantom_desktop";
    frame.seconds = 12;
    frame.limit_n = 3.3;
    frame.mode = mode;
    return frame;
}

TouchTotals busy() {
    TouchTotals totals;
    totals.ticks = 1000;
    totals.seconds = 1;
    totals.force_n = 1.65;
    totals.tool_depth_m = -4.2e-3;
    totals.hand_depth_m = 123e-3;
    totals.haptic_status_ticks[0] = 250;
    totals.recent_haptic_status = 0x7ff;
    totals.recent_step_status = 0xf;
    return totals;
}

TEST(Live_block, Never_is_wider_than_the_terminal_nor_changes_its_height) {
    for (const HapticMode mode : {HapticMode::synchronous, HapticMode::two_rate}) {
        const std::size_t height = live_block(frame(mode), {}, {}, 80).size();
        for (const std::size_t columns : {1U, 20U, 40U, 60U, 80U, 200U}) {
            const auto lines = live_block(frame(mode), busy(), {}, columns);
            EXPECT_EQ(lines.size(), height);
            for (const std::string& line : lines)
                EXPECT_LE(line.size(), columns) << line;
        }
    }
}

TEST(Live_block, Of_60_columns_shows_the_force_row_whole) {
    const auto lines = live_block(frame(HapticMode::synchronous), busy(), {}, 60);
    std::string row;
    for (const std::string& line : lines)
        if (line.find(" force ") != std::string::npos) row = line;
    EXPECT_THAT(row, HasSubstr("1.65 N ["));
    EXPECT_THAT(row, HasSubstr("50 % of 3.30 N"));
}

TEST(Live_block, Of_virtual_time_tells_no_clock) {
    LiveFrame still = frame(HapticMode::synchronous);
    still.virtual_time = true;
    for (const std::string& line : live_block(still, busy(), {}, 80)) {
        EXPECT_EQ(line.find("missed"), std::string::npos) << line;
        EXPECT_EQ(line.find(" us"), std::string::npos) << line;
    }
}

TEST(Live_line, Says_force_depth_saturation_and_status) {
    const std::string line = live_line(frame(HapticMode::synchronous), busy(), {});
    EXPECT_THAT(line, HasSubstr("1.650 N"));
    EXPECT_THAT(line, HasSubstr("-4.200 mm"));
    EXPECT_THAT(line, HasSubstr("25.0 %"));
    EXPECT_THAT(line, HasSubstr("saturated, "));
}

TEST(Bar, Fills_with_the_share_and_marks_the_limit) {
    EXPECT_EQ(bar(0, 4), "[----]");
    EXPECT_EQ(bar(0.5, 4), "[##--]");
    EXPECT_EQ(bar(0.999, 4), "[###-]");
    EXPECT_EQ(bar(1, 4), "[####!");
    EXPECT_EQ(bar(7, 4), "[####!");
    EXPECT_EQ(bar(-1, 4), "[----]");
}

}  // namespace
}  // namespace knead::tools::test
