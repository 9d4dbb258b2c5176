// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/error.h"
#include "scene/toml_table.h"

namespace knead::tools {
namespace {

using testing::HasSubstr;

constexpr const char* kCube = R"(name = "cube"
[mesh]
kind = "cubes"
size = "10cm"
divisions = 4
[material]
uniform_pa = 22000
[[level]]
name = "fine"
[[level]]
name = "k3"
bins = 2
clusters = 3
mesh = { divisions = 2 }
[[held]]
side = "bottom"
[[tool]]
name = "press"
shape = "plate"
contact = "bonded"
touches = { side = "top" }
)";

/// Writes scene files into the test's own folder.
class SceneFile : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& text) {
        const auto file =
            std::filesystem::path(testing::TempDir()) /
            (std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".toml");
        std::ofstream(file) << text;
        return file;
    }

    std::string replaced(const std::string& from, const std::string& to) {
        std::string text = kCube;
        const auto at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    }

    std::string error_of(const std::string& text) {
        try {
            (void)read_scene(write(text));
        } catch (const ToolError& error) {
            EXPECT_EQ(error.code(), ExitCode::bad_input);
            return error.what();
        }
        return "no error";
    }
};

TEST_F(SceneFile, Of_a_cube_is_read_with_units_and_defaults) {
    const Scene scene = read_scene(write(kCube));
    EXPECT_EQ(scene.name, "cube");
    EXPECT_EQ(scene.mesh.size_m, std::vector<double>{0.1});
    EXPECT_EQ(scene.levels.at(0).bins, 0u);
    EXPECT_FALSE(scene.levels.at(0).mesh.has_value());
    EXPECT_EQ(scene.levels.at(1).clusters, 3u);
    EXPECT_EQ(scene.levels.at(1).restarts, 5u);
    EXPECT_EQ(scene.tools.at(0).contact, ToolContact::bonded);
    EXPECT_EQ(scene.tools.at(0).line, 17u);
    EXPECT_FALSE(scene.needs_surface);
}

TEST_F(SceneFile, Level_mesh_inherits_what_it_does_not_say) {
    const Scene scene = read_scene(write(kCube));
    const MeshSource& coarse = scene.levels.at(1).mesh.value();
    EXPECT_EQ(coarse.kind, "cubes");
    EXPECT_EQ(coarse.divisions, std::vector<std::uint32_t>{2});
    EXPECT_EQ(coarse.size_m, std::vector<double>{0.1});
}

TEST_F(SceneFile, With_an_unknown_key_is_refused_with_line_and_nearest_key) {
    const std::string message = error_of(replaced("divisions = 4", "divisons = 4"));
    EXPECT_THAT(message, HasSubstr(".toml:5: "));
    EXPECT_THAT(
        error_of(replaced("clusters = 3", "clusters = 3\nclutsers = 3")),
        HasSubstr(".toml:14: unknown key \"level[1].clutsers\"; did you mean \"level[1].clusters\"?"));
}

TEST_F(SceneFile, With_a_required_key_misspelt_names_the_misspelling) {
    EXPECT_THAT(error_of(replaced("divisions = 4", "divisons = 4")), HasSubstr("divisons"));
}

TEST_F(SceneFile, With_bad_values_is_refused_with_the_key) {
    EXPECT_THAT(error_of(replaced("clusters = 3", "clusters = 0")),
                HasSubstr("level[1].clusters must be from 1"));
    EXPECT_THAT(error_of(replaced("bins = 2", "bins = -1")),
                HasSubstr("level[1].bins must be a whole number"));
    EXPECT_THAT(error_of(replaced("\"10cm\"", "\"10 parsecs\"")), HasSubstr("parsecs"));
    EXPECT_THAT(error_of(replaced("\"10cm\"", "-1")), HasSubstr("mesh.size must be positive"));
    EXPECT_THAT(error_of(replaced("\"10cm\"", "nan")), HasSubstr("mesh.size must be a length"));
    EXPECT_THAT(error_of(replaced("side = \"top\"", "side = \"tpo\"")), HasSubstr("did you mean \"top\"?"));
    EXPECT_THAT(error_of(replaced("uniform_pa = 22000", "uniform_pa = 22000\nscenario = 1")),
                HasSubstr("exactly one of"));
    EXPECT_THAT(error_of(replaced("name = \"k3\"", "name = \"fine\"")),
                HasSubstr("stands already at line 8"));
    EXPECT_THAT(error_of(replaced("name = \"cube\"", "name = \"../cube\"")), HasSubstr("letters, digits"));
}

/// More than a double holds exactly: such numbers once were read as whatever stood in memory.
TEST_F(SceneFile, With_whole_numbers_beyond_2_to_the_53_is_read) {
    const std::string odd = "9007199254740993", even = "9007199254740992";
    EXPECT_EQ(read_scene(write(replaced("\"10cm\"", odd))).mesh.size_m,
              read_scene(write(replaced("\"10cm\"", even))).mesh.size_m);
    EXPECT_THAT(error_of(replaced("divisions = 4", "divisions = [4, 4, " + odd + "]")),
                HasSubstr("from 1 to 1000"));
    EXPECT_THAT(error_of(replaced("divisions = 4", "divisions = " + odd)), HasSubstr("from 1 to 1000"));
}

TEST_F(SceneFile, With_an_orientation_that_is_not_finite_is_refused) {
    const std::string shape = "shape = \"plate\"";
    EXPECT_THAT(error_of(replaced(shape, shape + "\norientation_wxyz = [nan, 0, 0, 0]")),
                HasSubstr("array of finite numbers"));
}

TEST_F(SceneFile, That_is_not_toml_is_refused_with_the_line) {
    EXPECT_THAT(error_of("name = \"cube\"\nmesh = [\n"), HasSubstr("not valid TOML"));
    EXPECT_THAT(error_of("name = \"cube\"\n= 3\n"), HasSubstr(".toml:2: not valid TOML"));
}

/// Such a file once ended the stack: every part of a key is a table inside the one before.
TEST_F(SceneFile, With_a_key_of_very_many_parts_is_refused_with_its_line) {
    std::string deep = "name = \"cube\"\n[a";
    for (int i = 0; i < 200'000; ++i)
        deep += ".a";
    EXPECT_THAT(error_of(deep + "]\n"), HasSubstr(".toml:2: a key of more than 64 parts"));
    EXPECT_EQ(parse_toml("[a.b.c]\nd = [0.1, 0.2]\n", "x").size(), 1U);
}

TEST_F(SceneFile, That_is_missing_is_refused) {
    EXPECT_THROW((void)read_scene("/nonexistent/scene.toml"), ToolError);
}

TEST_F(SceneFile, With_a_box_reads_both_corners_with_units) {
    const Scene scene =
        read_scene(write(replaced("side = \"top\"", "box = [[\"1cm\", 0, 0], [0.09, \"9cm\", 1]]")));
    const auto box = scene.tools.at(0).touches.box_m.value();
    EXPECT_EQ(box[0], (Point{0.01, 0, 0}));
    EXPECT_EQ(box[1], (Point{0.09, 0.09, 1}));
}

TEST_F(SceneFile, With_a_capsule_and_friction_is_read_with_units) {
    const Scene scene =
        read_scene(write(replaced("shape = \"plate\"\ncontact = \"bonded\"",
                                  "shape = \"capsule\"\nradius = \"5mm\"\nhalf_length = \"2cm\"\n"
                                  "contact = \"coulomb\"\nfriction = 0.3")));
    const SceneTool& tool = scene.tools.at(0);
    EXPECT_EQ(tool.shape, ToolShape::capsule);
    EXPECT_EQ(tool.contact, ToolContact::coulomb);
    EXPECT_EQ(tool.radius_m, 0.005);
    EXPECT_EQ(tool.half_length_m, 0.02);
    EXPECT_EQ(tool.friction_coefficient, 0.3);
}

TEST_F(SceneFile, With_a_capsule_that_lacks_a_length_is_refused_with_its_line) {
    const auto error = [&](const std::string& lines) {
        return error_of(replaced("shape = \"plate\"", "shape = \"capsule\"\n" + lines));
    };
    EXPECT_THAT(error("radius = 0.01"), HasSubstr("tool[0].half_length is required for a capsule"));
    EXPECT_THAT(error("half_length = 0.01"), HasSubstr("tool[0].radius is required for a capsule"));
    EXPECT_THAT(error("radius = 0.01\nhalf_length = 0"),
                HasSubstr(".toml:21: tool[0].half_length must be positive"));
    EXPECT_THAT(
        error("radius = 0.01\nhalf_lenght = 0.1"),
        HasSubstr(".toml:21: unknown key \"tool[0].half_lenght\"; did you mean \"tool[0].half_length\"?"));
    EXPECT_THAT(error("radius = 0.01\nhalf_length = 0.1\nhalf_extents = [1, 1]"),
                HasSubstr(".toml:22: unknown key \"tool[0].half_extents\""));
    EXPECT_THAT(error_of(replaced("\"plate\"", "\"capsul\"")), HasSubstr("did you mean \"capsule\"?"));
}

TEST_F(SceneFile, With_friction_that_nobody_uses_or_that_makes_no_sense_is_refused_with_its_line) {
    const auto error = [&](const std::string& lines) {
        return error_of(replaced("contact = \"bonded\"", lines));
    };
    EXPECT_THAT(error("contact = \"coulomb\""), HasSubstr("tool[0].friction is required for contact"));
    EXPECT_THAT(error("contact = \"coulomb\"\nfricton = 1"), HasSubstr("did you mean \"tool[0].friction\"?"));
    for (const char* bad : {"0", "-0.3", "10.01"})
        EXPECT_THAT(error(std::string("contact = \"coulomb\"\nfriction = ") + bad),
                    HasSubstr(".toml:21: tool[0].friction must be greater than 0 and at most 10"));
    EXPECT_THAT(error("contact = \"coulomb\"\nfriction = nan"), HasSubstr("must be a finite number"));
    EXPECT_THAT(error("contact = \"sticking\"\nfriction = 0.3"),
                HasSubstr(".toml:21: tool[0].friction belongs to contact = \"coulomb\" only"));
    EXPECT_THAT(error("contact = \"columb\""), HasSubstr("did you mean \"coulomb\"?"));
}

TEST_F(SceneFile, With_an_embedding_reads_its_file_beside_the_scene_and_its_unit) {
    const Scene scene =
        read_scene(write(std::string(kCube) +
                         "[embedding]\nfile = \"skin.stl\"\nlength_unit = \"mm\"\nmax_distance = \"3mm\"\n"));
    ASSERT_TRUE(scene.embedding.has_value());
    EXPECT_EQ(scene.embedding->file, scene.file.parent_path() / "skin.stl");
    EXPECT_EQ(scene.embedding->metres_per_unit, 1e-3);
    EXPECT_EQ(scene.embedding->max_distance_m, 3e-3);
    EXPECT_EQ(scene.embedding->line, 22u);
    EXPECT_FALSE(read_scene(write(kCube)).embedding.has_value());
}

TEST_F(SceneFile, With_an_incomplete_embedding_is_refused_with_its_line) {
    const auto error = [&](const std::string& lines) {
        return error_of(std::string(kCube) + "[embedding]\n" + lines);
    };
    EXPECT_THAT(error("length_unit = \"mm\"\n"), HasSubstr(".toml:22: embedding.file is required"));
    EXPECT_THAT(error("file = \"a.stl\"\n"), HasSubstr("embedding.length_unit is required: STL and PLY"));
    EXPECT_THAT(error("file = \"a.stl\"\nlength_unit = \"m\"\nmax_distance = 0\n"),
                HasSubstr(".toml:25: embedding.max_distance must be positive"));
    EXPECT_THAT(error("file = \"a.stl\"\nlength_unit = \"m\"\nmax_distence = 1\n"),
                HasSubstr("did you mean \"embedding.max_distance\"?"));
    EXPECT_THAT(error_of(std::string(kCube) + "[embeding]\nfile = \"a.stl\"\n"),
                HasSubstr(".toml:22: unknown key \"embeding\"; did you mean \"embedding\"?"));
}

TEST(NearestWord, Is_the_one_with_the_smallest_edit_distance_and_empty_when_none_is_near) {
    EXPECT_EQ(nearest_word("clutsers", {"bins", "clusters", "name"}), "clusters");
    EXPECT_EQ(nearest_word("xyzzy", {"bins", "clusters"}), "");
}

}  // namespace
}  // namespace knead::tools
