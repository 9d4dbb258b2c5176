// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "mesh/recognise.h"
#include "unit/mesh/samples.h"

namespace knead::tools {
namespace {

using namespace test;

TEST(Recognise, Each_format_by_its_content) {
    EXPECT_EQ(recognise(small_msh()), FileFormat::msh);
    EXPECT_EQ(recognise("$NOD\n1\n1 0 0 0\n$ENDNOD\n$ELM\n0\n$ENDELM\n"), FileFormat::msh);
    EXPECT_EQ(recognise(small_medit()), FileFormat::medit);
    EXPECT_EQ(recognise(small_vtk()), FileFormat::vtk);
    EXPECT_EQ(recognise(small_veg()), FileFormat::veg);
    EXPECT_EQ(recognise(cube_stl(0, 1)), FileFormat::stl_text);
    EXPECT_EQ(recognise(cube_stl_binary(0, 1)), FileFormat::stl_binary);
    EXPECT_EQ(recognise(cube_ply(0, 1)), FileFormat::ply);
    EXPECT_EQ(recognise("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"),
              FileFormat::step);
    EXPECT_EQ(recognise("\nDBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\n"),
              FileFormat::brep);
    EXPECT_EQ(recognise("CASCADE Topology V3, (c) Open Cascade\n"), FileFormat::brep);
}

TEST(Recognise, A_binary_stl_whose_header_says_solid_as_binary) {
    std::string bytes = cube_stl_binary(0, 1);
    bytes.replace(0, 6, "solid ");
    EXPECT_EQ(recognise(bytes), FileFormat::stl_binary);
}

TEST(Recognise, Scripts_and_other_content_are_refused) {
    KNEAD_EXPECT_REFUSAL(recognise("SystemCall \"touch /tmp/x\";\n"), bad_input, "never run");
    KNEAD_EXPECT_REFUSAL(recognise("Point(1) = {0,0,0};"), bad_input, "Point(1)");
    KNEAD_EXPECT_REFUSAL(recognise(""), bad_input, "empty");
    KNEAD_EXPECT_REFUSAL(recognise("\x89HDF\r\n\x1a\n"), bad_input, "HDF5");
    KNEAD_EXPECT_REFUSAL(recognise(std::string("\0\1\2", 3)), bad_input, "binary");
    // What gmsh takes for a mesh or a view by its first letters is not one for us.
    KNEAD_EXPECT_REFUSAL(recognise("$NOTHING\nSystemCall \"x\";\n"), bad_input, "none of the formats");
    KNEAD_EXPECT_REFUSAL(recognise("$PostFormat\n"), bad_input, "none of the formats");
    KNEAD_EXPECT_REFUSAL(recognise(" " + small_msh()), bad_input, "none of the formats");
    KNEAD_EXPECT_REFUSAL(recognise("\xef\xbb\xbf" + small_msh()), bad_input, "none of the formats");
}

TEST(Recognise, A_script_before_between_or_after_the_sections_of_a_mesh_is_refused) {
    const std::string script = "SystemCall \"touch /tmp/x\";\n";
    KNEAD_EXPECT_REFUSAL(recognise(small_msh() + script), bad_input, "outside of the sections");
    std::string between = small_msh();
    between.insert(between.find("$Nodes"), script);
    KNEAD_EXPECT_REFUSAL(recognise(between), bad_input, "outside of the sections");
    KNEAD_EXPECT_REFUSAL(recognise("$MeshFormat\n" + script + small_msh()), bad_input, "version");
}

TEST(Recognise, A_mesh_that_was_cut_off_is_refused_wherever_it_was_cut) {
    const std::string whole = small_msh();
    for (std::size_t size = 0; size + 1 < whole.size(); ++size)
        EXPECT_THROW((void)recognise(whole.substr(0, size)), ToolError) << size;
    KNEAD_EXPECT_REFUSAL(recognise("ISO-10303-21;\nHEADER;\n"), bad_input, "cut off");
}

TEST(Recognise, Versions_of_msh_that_are_not_known_are_refused) {
    std::string text = small_msh();
    text.replace(text.find("2.2 0 8"), 7, "9.0 0 8");
    KNEAD_EXPECT_REFUSAL(recognise(text), bad_input, "versions 1, 2 and 4");
}

TEST(Extension, That_contradicts_the_content_is_refused_and_both_are_named) {
    KNEAD_EXPECT_REFUSAL(require_matching_extension(FileFormat::stl_text, ".msh"), bad_input,
                         "a text STL file");
    KNEAD_EXPECT_REFUSAL(require_matching_extension(FileFormat::msh, ".STL"), bad_input, ".STL");
    EXPECT_NO_THROW(require_matching_extension(FileFormat::msh, ".MSH"));
    EXPECT_NO_THROW(require_matching_extension(FileFormat::msh, ""));
    EXPECT_NO_THROW(require_matching_extension(FileFormat::stl_binary, ".stl"));
    EXPECT_NO_THROW(require_matching_extension(FileFormat::step, ".p21"));
}

}  // namespace
}  // namespace knead::tools
