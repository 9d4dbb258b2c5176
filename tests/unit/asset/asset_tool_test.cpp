// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "asset/commands.h"
#include "asset/export_mesh.h"
#include "asset/info.h"
#include "asset/json.h"
#include "common/error.h"
#include "unit/formats/samples.h"

namespace knead::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Json_string, Escapes_what_JSON_forbids) {
    EXPECT_EQ(json_string("a\"b\\c\n\x01"), "\"a\\\"b\\\\c\\u000a\\u0001\"");
    EXPECT_EQ(json_string("gr\xc3\xbc\xc3\x9f"), "\"gr\xc3\xbc\xc3\x9f\"");
}

TEST(Json_string, Replaces_bytes_that_are_not_UTF_8) {
    for (const char* bad : {"\xff", "\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf5\x80\x80\x80"})
        EXPECT_THAT(json_string(bad), HasSubstr("\\ufffd")) << json_string(bad);
}

TEST(Json_writer, Nests_and_separates) {
    JsonWriter json;
    json.open_object().number("a", std::uint64_t{1}).open_array("b").number("", 0.5).close_array();
    json.open_object("c").close_object().boolean("d", true).close_object();
    EXPECT_EQ(json.take(), "{\n  \"a\": 1,\n  \"b\": [\n    0.5\n  ],\n  \"c\": {},\n  \"d\": true\n}\n");
}

TEST(Request_of_a_group, Is_that_of_the_nearest_group_above) {
    Asset asset;
    asset.requests = {{"/knead/asset", "object", 3}, {"/knead/asset/tools/000000", "tool[0]", 12}};
    EXPECT_EQ(request_for(asset, "/knead/asset/tools/000000/nodes")->scene_line, 12U);
    EXPECT_EQ(request_for(asset, "/knead/asset/tools")->scene_line, 3U);
    EXPECT_EQ(request_for(asset, "/knead"), nullptr);
}

TEST(Tolerances, Are_read_for_all_data_and_for_one_dataset) {
    const CompareOptions options = compare_options({"1e-9", "nodes_m=0.5"}, {"nodes_m=2"});
    EXPECT_EQ(options.tolerance.absolute, 1e-9);
    EXPECT_EQ(options.dataset_tolerance.at("nodes_m").absolute, 0.5);
    EXPECT_EQ(options.dataset_tolerance.at("nodes_m").relative, 2);
    for (const char* bad : {"", "x", "-1", "1x", "nodes_m=", "nan", "inf"})
        EXPECT_THROW((void)compare_options({bad}, {}), ToolError) << bad;
}

TEST(Info_of_an_asset, Shows_groups_bytes_and_the_line_of_the_scene) {
    const test::Folder folder;
    const Asset asset = test::sample_asset();
    ASSERT_TRUE(write_asset(folder / "a.hdf", asset, test::sample_provenance()).ok());
    const Description description{inspect_file(folder / "a.hdf").value(), asset};
    const std::string text = info_text(description);
    EXPECT_THAT(text, HasSubstr("asked for by app.gravity (line 30)"));
    EXPECT_THAT(text, HasSubstr("needs           capsule_tool\nneeds           coulomb_contact\n"));
    EXPECT_THAT(text, HasSubstr("ball: sphere of radius 0.01 m, frictionless, 0 nodes\n"));
    EXPECT_THAT(text, HasSubstr("finger: capsule of radius 0.005 m and half length 0.02 m, "
                                "coulomb with friction 0.3, 2 nodes\n"));
    EXPECT_THAT(
        text, HasSubstr("numerics        contrast 10, Poisson's ratio up to 0.45, 6 tetrahedra: solved in "
                        "float32 (contrast up to 1e+04), preconditioned by the factor of the rest state (few "
                        "tetrahedra) kept in fixed16 (contrast up to 1e+06)\n"));
    EXPECT_THAT(text, HasSubstr("embedding       4 vertices, 1 of them still, 2 triangles\n"));
    EXPECT_THAT(text, HasSubstr("--name=a b"));
    EXPECT_THAT(text, HasSubstr("E 22000 Pa, nu 0.3, density 1000 kg/m^3, 3 tetrahedra"));
    const std::string json = info_json(description);
    EXPECT_THAT(json, HasSubstr("\"scene_key\": \"app.gravity\",\n      \"scene_line\": 30"));
    EXPECT_THAT(json, HasSubstr("\"kind\": \"asset\""));
}

TEST(Export_to_vtu, Holds_every_node_element_and_value) {
    const std::string text = vtu_text(export_mesh(test::sample_clustering()));
    EXPECT_THAT(text, HasSubstr("NumberOfPoints=\"8\" NumberOfCells=\"6\""));
    for (const char* name :
         {"E in/kPa", "youngs_modulus_pa", "poissons_ratio", "density_kg_per_m3", "bin", "cluster"})
        EXPECT_THAT(text, HasSubstr(std::string("Name=\"") + name + "\"")) << name;
    EXPECT_THAT(text, HasSubstr("\n2200\n22000\n2200\n"));
    EXPECT_THAT(text, Not(HasSubstr("\t")));
}

TEST(Export_of_arrays_with_taken_names, Renames_those_that_came_with_the_mesh) {
    ClusteredObject object = test::sample_clustering();
    object.mesh.cell_arrays[0].name = "bin";
    const ExportMesh mesh = export_mesh(object);
    EXPECT_EQ(mesh.fields[0].name, "bin_2");
    EXPECT_EQ(mesh.fields[0].values[0], 22.5);
}

/// Reads $Nodes and $Elements of a .msh 2.2 text back, written from the format's description.
TEST(Export_to_msh, Can_be_read_back) {
    const MaterialObject object = test::sample_material();
    std::istringstream text(msh_text(export_mesh(object)));
    std::string word;
    while (text >> word && word != "$Nodes") {
    }
    std::size_t count = 0, id = 0;
    ASSERT_TRUE(text >> count);
    ASSERT_EQ(count, object.mesh.nodes_m.size());
    for (const Point& p : object.mesh.nodes_m) {
        Point q{};
        text >> id >> q[0] >> q[1] >> q[2];
        EXPECT_EQ(q, p);
    }
    text >> word >> word >> count;
    ASSERT_EQ(word, "$Elements");
    ASSERT_EQ(count, object.mesh.tetrahedra.size());
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t type = 0, tags = 0, physical = 0, elementary = 0, node = 0;
        text >> id >> type >> tags >> physical >> elementary;
        EXPECT_EQ(id, i + 1);
        EXPECT_EQ(type, 4U);
        EXPECT_EQ(tags, 2U);
        EXPECT_EQ(physical, object.mesh.regions.region_of_tetrahedron[i] + 1U);
        for (const std::uint32_t expected : object.mesh.tetrahedra[i]) {
            text >> node;
            EXPECT_EQ(node, expected + 1U);
        }
    }
    EXPECT_TRUE(text.good());
    EXPECT_THAT(text.str(), HasSubstr("$PhysicalNames\n2\n3 1 \"muscle\"\n"));
    EXPECT_THAT(text.str(), HasSubstr("\"youngs_modulus_pa\"\n1\n0\n3\n0\n1\n6\n1 2200\n2 22000\n"));
}

TEST(Issue_line, Names_place_code_and_message) {
    EXPECT_EQ(issue_line({ErrorCode::wrong_type, "is text", "a.hdf#/x"}), "a.hdf#/x: wrong_type: is text");
}

}  // namespace
}  // namespace knead::tools
