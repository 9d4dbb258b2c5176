// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "mesh/veg.h"
#include "unit/mesh/samples.h"

namespace knead::tools {
namespace {

using namespace test;

std::string no_includes(const std::string& name) {
    throw ToolError(ExitCode::bad_input, "no " + name);
}

TEST(Veg, Keeps_tetrahedra_regions_and_materials) {
    const RawMesh mesh = read_veg(small_veg(), no_includes);
    EXPECT_EQ(mesh.nodes.size(), 5U);
    EXPECT_EQ(mesh.tetrahedra, (std::vector<std::array<std::int64_t, 4>>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
    EXPECT_EQ(mesh.regions.names, (std::vector<std::string>{"outer", "inner"}));
    EXPECT_EQ(mesh.regions.region_of_tetrahedron, (std::vector<std::uint32_t>{0, 1}));
    ASSERT_EQ(mesh.cell_arrays.size(), 3U);
    EXPECT_EQ(mesh.cell_arrays[0].name, "youngs_modulus_pa");
    EXPECT_EQ(mesh.cell_arrays[0].values, (std::vector<double>{40000, 5000}));
    EXPECT_EQ(mesh.cell_arrays[1].name, "poissons_ratio");
    EXPECT_EQ(mesh.cell_arrays[1].values, (std::vector<double>{0.45, 0.3}));
    EXPECT_EQ(mesh.cell_arrays[2].name, "density_kg_per_m3");
    EXPECT_EQ(mesh.cell_arrays[2].values, (std::vector<double>{1100, 1000}));
}

TEST(Veg, Numbered_from_zero_gives_the_same_mesh) {
    const RawMesh mesh = read_veg(
        "*VERTICES\n5 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1\n*ELEMENTS\nTET\n2 4 0\n"
        "0 0 1 2 3\n1 1 2 3 4\n*MATERIAL m\nENU,1,2,0.3\n*SET second\n1\n*REGION\nallElements,m\n"
        "*REGION\nsecond,m\n",
        no_includes);
    EXPECT_EQ(mesh.tetrahedra, read_veg(small_veg(), no_includes).tetrahedra);
    EXPECT_EQ(mesh.regions.region_of_tetrahedron, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(mesh.tetrahedron_numbers, (std::vector<std::int64_t>{0, 1}));
}

TEST(Veg, Includes_stand_where_they_are_named) {
    std::string text = small_veg();
    text.replace(text.find("*SET inner\n2\n"), 13, "*SET inner\n*INCLUDE inner.txt\n");
    const RawMesh mesh = read_veg(text, [](const std::string& name) {
        EXPECT_EQ(name, "inner.txt");
        return std::string("# list\n2,\n");
    });
    EXPECT_EQ(mesh.regions.region_of_tetrahedron, (std::vector<std::uint32_t>{0, 1}));
    KNEAD_EXPECT_REFUSAL(read_veg("*INCLUDE a", [](const std::string&) { return std::string("*INCLUDE a"); }),
                         bad_input, "deeply");
    const std::string zero_byte("*INCLUDE a\0b", 12);
    KNEAD_EXPECT_REFUSAL(read_veg(zero_byte, [](const std::string&) { return std::string(); }), bad_input,
                         "zero byte");
}

TEST(Veg, Vertex_before_the_first_is_out_of_range_and_not_an_overflow) {
    std::string text = small_veg();
    text.replace(text.find("1 1 2 3 4\n"), 10, "1 -9223372036854775808 2 3 4\n");
    EXPECT_EQ(read_veg(text, no_includes).tetrahedra[0][0], -1);
}

TEST(Veg, Broken_content_is_refused_with_its_line) {
    const auto with = [](const std::string& old_text, const std::string& new_text) {
        std::string text = small_veg();
        return text.replace(text.find(old_text), old_text.size(), new_text);
    };
    KNEAD_EXPECT_REFUSAL(read_veg(with("2 1 0 0", "3 1 0 0"), no_includes), bad_input, "line 5: vertex 2");
    KNEAD_EXPECT_REFUSAL(read_veg(with("2 2 3 4 5", "2 2 3 4"), no_includes), bad_input, "line 13");
    KNEAD_EXPECT_REFUSAL(read_veg(with("*SET outer\n1", "*SET outer\n9"), no_includes), bad_input,
                         "names element 9");
    KNEAD_EXPECT_REFUSAL(read_veg(with("outer, hard", "outer, iron"), no_includes), bad_input,
                         "no material \"iron\"");
    KNEAD_EXPECT_REFUSAL(read_veg(with("outer, hard", "rim, hard"), no_includes), bad_input,
                         "no set \"rim\"");
    KNEAD_EXPECT_REFUSAL(read_veg(with("*REGION\ninner, soft\n", ""), no_includes), bad_input,
                         "1 of 2 elements are in no *REGION");
    KNEAD_EXPECT_REFUSAL(read_veg(with("5 3 0 0", "5000 3 0 0"), no_includes), bad_input, "fewer lines");
    KNEAD_EXPECT_REFUSAL(read_veg(with("ENU, 1000, 5000, 0.3", "ENU, 1000, x, 0.3"), no_includes), bad_input,
                         "number");
    KNEAD_EXPECT_REFUSAL(read_veg(small_veg() + "*SHELL s\n", no_includes), bad_input, "*SHELL");
    KNEAD_EXPECT_REFUSAL(read_veg("*VERTICES\n1 3\n1 0 0 0\n", no_includes), bad_input, "*ELEMENTS");
}

TEST(Veg, Cubic_elements_are_counted_as_left_out) {
    const RawMesh mesh =
        read_veg("*VERTICES\n1 3 0 0\n1 0 0 0\n*ELEMENTS\nCUBIC\n1 8 0\n1 1 1 1 1 1 1 1 1\n", no_includes);
    EXPECT_TRUE(mesh.tetrahedra.empty());
    EXPECT_EQ(mesh.other_cells[0], (std::pair<std::string, std::size_t>("cubes", 1)));
}

}  // namespace
}  // namespace knead::tools
