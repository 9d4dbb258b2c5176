// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "mesh/medit.h"
#include "mesh/outline.h"
#include "mesh/vtk.h"
#include "unit/mesh/samples.h"

namespace knead::tools {
namespace {

using namespace test;
using Corners = std::array<std::int64_t, 4>;

TEST(Medit, Keeps_tetrahedra_and_references_and_counts_other_cells) {
    const RawMesh mesh = read_medit(small_medit());
    EXPECT_EQ(mesh.nodes.size(), 5U);
    EXPECT_EQ(mesh.nodes[4], (Point{1, 1, 1}));
    EXPECT_EQ(mesh.tetrahedra, (std::vector<Corners>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
    EXPECT_EQ(mesh.regions.names, (std::vector<std::string>{"reference_10", "reference_20"}));
    EXPECT_EQ(mesh.regions.region_of_tetrahedron, (std::vector<std::uint32_t>{0, 1}));
    ASSERT_EQ(mesh.other_cells.size(), 1U);
    EXPECT_EQ(mesh.other_cells[0], (std::pair<std::string, std::size_t>("Triangles", 1)));
}

TEST(Medit, Vertex_before_the_first_is_out_of_range_and_not_an_overflow) {
    std::string text = small_medit();
    text.replace(text.find("1 2 3 4 10"), 1, "-9223372036854775808");
    EXPECT_EQ(read_medit(text).tetrahedra[0][0], -1);
}

TEST(Medit, Script_text_and_broken_sections_are_refused) {
    KNEAD_EXPECT_REFUSAL(read_medit(small_medit() + "SystemCall \"x\";"), bad_input, "after its End");
    KNEAD_EXPECT_REFUSAL(read_medit("MeshVersionFormatted 2\nSystemCall \"x\";\n"), bad_input, "SystemCall");
    KNEAD_EXPECT_REFUSAL(read_medit("MeshVersionFormatted 2\nDimension 2\n"), bad_input, "three-dimensional");
    KNEAD_EXPECT_REFUSAL(read_medit("MeshVersionFormatted 2\nDimension 3\nVertices -1\n"), bad_input, "-1");
    KNEAD_EXPECT_REFUSAL(read_medit("MeshVersionFormatted 2\nDimension 3\nVertices 99999999999\n"), bad_input,
                         "too short");
}

TEST(Vtk, Keeps_tetrahedra_and_their_scalars_and_tells_what_it_leaves_out) {
    const RawMesh mesh = read_vtk(small_vtk());
    EXPECT_EQ(mesh.nodes.size(), 5U);
    EXPECT_EQ(mesh.tetrahedra, (std::vector<Corners>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
    EXPECT_EQ(mesh.tetrahedron_numbers, (std::vector<std::int64_t>{1, 2}));
    ASSERT_EQ(mesh.cell_arrays.size(), 1U);
    EXPECT_EQ(mesh.cell_arrays[0].name, "stiffness");
    EXPECT_EQ(mesh.cell_arrays[0].values, (std::vector<double>{2, 3}));
    EXPECT_EQ(mesh.other_cells[0], (std::pair<std::string, std::size_t>("triangles", 1)));
    ASSERT_EQ(mesh.notes.size(), 2U);
    EXPECT_NE(mesh.notes[0].text.find("fibre"), std::string::npos);
    EXPECT_NE(mesh.notes[1].text.find("height"), std::string::npos);
}

template <class T>
void append_big_endian(std::string& bytes, std::initializer_list<T> values) {
    for (const T value : values) {
        char raw[sizeof(T)];
        std::memcpy(raw, &value, sizeof(T));
        for (std::size_t i = sizeof(T); i-- > 0;)
            bytes += raw[i];
    }
}

TEST(Vtk, Version_5_in_binary_gives_the_same_mesh) {
    std::string bytes =
        "# vtk DataFile Version 5.1\nsmall\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n";
    append_big_endian<double>(bytes, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1});
    bytes += "\nMETADATA\nINFORMATION 0\n\nCELLS 3 8\nOFFSETS vtktypeint64\n";
    append_big_endian<std::int64_t>(bytes, {0, 4, 8});
    bytes += "\nCONNECTIVITY vtktypeint64\n";
    append_big_endian<std::int64_t>(bytes, {0, 1, 2, 3, 1, 2, 3, 4});
    bytes += "\nCELL_TYPES 2\n";
    append_big_endian<std::int32_t>(bytes, {10, 10});
    bytes += "\nCELL_DATA 2\nFIELD FieldData 1\nstiffness 1 2 float\n";
    append_big_endian<float>(bytes, {2.5F, 3.5F});
    bytes += "\n";
    const RawMesh mesh = read_vtk(bytes);
    EXPECT_EQ(mesh.nodes, read_vtk(small_vtk()).nodes);
    EXPECT_EQ(mesh.tetrahedra, (std::vector<Corners>{{0, 1, 2, 3}, {1, 2, 3, 4}}));
    ASSERT_EQ(mesh.cell_arrays.size(), 1U);
    EXPECT_EQ(mesh.cell_arrays[0].values, (std::vector<double>{2.5, 3.5}));
}

TEST(Vtk, Numbers_that_are_no_index_name_no_node_and_no_type) {
    for (const char* corner : {"nan", "1e300", "-1", "1.5"}) {
        std::string text = small_vtk();
        text.replace(text.find("4 1 2 3 4") + 8, 1, corner);
        EXPECT_EQ(read_vtk(text).tetrahedra[1][3], -1) << corner;
    }
    for (const char* type : {"nan", "1e300", "256"}) {
        std::string text = small_vtk();
        text.replace(text.find("CELL_TYPES 3\n5") + 13, 1, type);
        KNEAD_EXPECT_REFUSAL(read_vtk(text), bad_input, "for its type");
    }
}

TEST(Vtk, Broken_content_is_refused) {
    KNEAD_EXPECT_REFUSAL(read_vtk(small_vtk() + "SystemCall \"x\";\n"), bad_input, "SystemCall");
    KNEAD_EXPECT_REFUSAL(read_vtk("# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\n"), bad_input,
                         "UNSTRUCTURED_GRID");
    std::string longer = small_vtk();
    longer.replace(longer.find("3 0 1 2\n"), 8, "9 0 1 2\n");
    KNEAD_EXPECT_REFUSAL(read_vtk(longer), bad_input, "cell");
    const std::string whole = small_vtk().substr(0, small_vtk().find("CELL_DATA"));
    for (std::size_t size = whole.find("CELL_TYPES"); size + 3 < whole.size(); ++size)
        EXPECT_THROW((void)read_vtk(whole.substr(0, size)), ToolError) << size;
}

TEST(Outline, Reads_corners_with_commas_comments_and_a_repeated_first_corner) {
    const auto corners = read_outline("# x,y\n0,0\n 1.5, 0 \n1,1 # corner\n\n0 1\n0,0\n");
    ASSERT_EQ(corners.size(), 4U);
    EXPECT_EQ(corners[1], (std::array<double, 2>{1.5, 0}));
}

TEST(Outline, Of_more_corners_than_can_be_compared_is_refused) {
    std::string text;
    for (int i = 0; i <= 10'000; ++i)
        text += std::to_string(i) + ",0\n";
    KNEAD_EXPECT_REFUSAL(read_outline(text), bad_input, "line 10001: more than 10000 corners");
}

TEST(Outline, That_is_broken_or_crosses_itself_is_refused) {
    KNEAD_EXPECT_REFUSAL(read_outline("0,0\n1,0\n"), bad_input, "three corners");
    KNEAD_EXPECT_REFUSAL(read_outline("0,0\n1,x\n1,1\n"), bad_input, "line 2");
    KNEAD_EXPECT_REFUSAL(read_outline("0,0\n1,0,0\n1,1\n"), bad_input, "line 2");
    KNEAD_EXPECT_REFUSAL(read_outline("0,0\n1,inf\n1,1\n"), bad_input, "line 2");
    KNEAD_EXPECT_REFUSAL(read_outline("0,0\n0,0\n1,1\n"), bad_input, "twice in a row");
    KNEAD_EXPECT_REFUSAL(read_outline("0,0\n1,1\n1,0\n0,1\n"), bad_input, "crosses itself");
}

}  // namespace
}  // namespace knead::tools
