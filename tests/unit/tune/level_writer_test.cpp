// SPDX-License-Identifier: Apache-2.0
#include "tune/level_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace knead::tools {
namespace {

using testing::HasSubstr;

constexpr const char* kScene = R"(name = "steak"  # häm: two bytes for one letter
[mesh]
kind = "outline"
points = "outline.csv"  # stays
[embedding]
file = "parts/skin.stl"
length_unit = "mm")";
constexpr const char* kLevel = "[[level]]\nname = \"tuned\"\n";

TEST(Scene_with_level, In_the_same_folder_is_the_text_and_the_level) {
    const std::string text = scene_with_level(kScene, "here/steak.toml", kLevel, "here/tuned.toml");
    EXPECT_EQ(text, std::string(kScene) + "\n\n" + kLevel);
}

TEST(Scene_with_level, In_another_folder_finds_its_files_from_there) {
    const std::string text = scene_with_level(kScene, "here/steak.toml", kLevel, "there/tuned.toml");
    EXPECT_THAT(text, HasSubstr("points = \"../here/outline.csv\"  # stays"));
    EXPECT_THAT(text, HasSubstr("file = \"../here/parts/skin.stl\"\n"));
    EXPECT_THAT(text, HasSubstr("häm"));
    EXPECT_THAT(text, HasSubstr(kLevel));
}

}  // namespace
}  // namespace knead::tools
