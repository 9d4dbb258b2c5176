// SPDX-License-Identifier: Apache-2.0
#include "material/sources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using namespace tools;

std::string bad_input(const std::function<void()>& call) {
    try {
        call();
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    return "no error";
}

/// Six tetrahedra in the regions fat, lean and bone.
TetMesh marbled() {
    TetMesh mesh = kuhn_cube(1);
    mesh.regions = {{"fat", "lean", "bone"}, {0, 1, 1, 2, 0, 1}};
    mesh.cell_arrays = {{"youngs_modulus_pa", {1, 2, 3, 4, 5, 6}}, {"stiffness", {9, 8, 7, 6, 5, 4}}};
    return mesh;
}

const std::vector<RegionValues> kMeat{
    {"bone", 3e6, 0.2, 1900}, {"fat", 1e3, 0.49, 900}, {"lean", 2e4, 0.45, 1060}};

TEST(Regions, Every_tetrahedron_gets_its_regions_values_in_any_order) {
    const Material material = material_of_regions(marbled(), kMeat);
    EXPECT_THAT(material.youngs_modulus_pa, ElementsAre(1e3, 2e4, 2e4, 3e6, 1e3, 2e4));
    EXPECT_THAT(material.poissons_ratio, ElementsAre(0.49, 0.45, 0.45, 0.2, 0.49, 0.45));
    EXPECT_THAT(material.density_kg_per_m3, ElementsAre(900, 1060, 1060, 1900, 900, 1060));
}

TEST(Regions, Unknown_names_are_refused_with_the_nearest_known) {
    auto values = kMeat;
    values[2].region = "leen";
    EXPECT_THAT(bad_input([&] { return material_of_regions(marbled(), values); }),
                HasSubstr("\"leen\"; did you mean \"lean\""));
}

TEST(Regions, Missing_and_double_ones_are_refused) {
    EXPECT_THAT(bad_input([&] { return material_of_regions(marbled(), {kMeat[1]}); }),
                HasSubstr("2 of 3 regions have no values: lean, bone"));
    auto twice = kMeat;
    twice.push_back(kMeat[0]);
    EXPECT_THAT(bad_input([&] { return material_of_regions(marbled(), twice); }),
                HasSubstr("\"bone\" is given twice"));
    EXPECT_THAT(bad_input([&] { return material_of_regions(kuhn_cube(1), kMeat); }),
                HasSubstr("has no regions"));
}

TEST(Array, Gives_the_moduli_and_defaults_fill_the_rest) {
    const Material material = material_of_array(marbled(), "stiffness", {0.25, 800});
    EXPECT_THAT(material.youngs_modulus_pa, ElementsAre(9, 8, 7, 6, 5, 4));
    EXPECT_THAT(material.poissons_ratio, Each(0.25));
    EXPECT_THAT(material.density_kg_per_m3, Each(800));
}

TEST(Array, An_unknown_one_is_refused_with_the_nearest_known) {
    EXPECT_THAT(bad_input([] { return material_of_array(marbled(), "stifness", {}); }),
                HasSubstr("did you mean \"stiffness\""));
    EXPECT_THAT(bad_input([] { return material_of_array(kuhn_cube(1), "E", {}); }), HasSubstr("none at all"));
}

TEST(Own_arrays, Poissons_ratio_and_density_are_taken_where_they_are) {
    TetMesh mesh = marbled();
    EXPECT_THAT(material_of_mesh(mesh, {0.3, 1000}).poissons_ratio, Each(0.3));
    mesh.cell_arrays.push_back({"poissons_ratio", {.1, .2, .3, .4, .1, .2}});
    mesh.cell_arrays.push_back({"density_kg_per_m3", {1, 2, 3, 4, 5, 6}});
    const Material material = material_of_mesh(mesh, {0.3, 1000});
    EXPECT_THAT(material.youngs_modulus_pa, ElementsAre(1, 2, 3, 4, 5, 6));
    EXPECT_THAT(material.poissons_ratio, ElementsAre(.1, .2, .3, .4, .1, .2));
    EXPECT_THAT(material.density_kg_per_m3, ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(Table, Rows_must_be_exactly_as_many_as_tetrahedra) {
    EXPECT_THAT(bad_input([] {
                    return material_of_table(marbled(), {{1, 2, 3, 4, 5}, {}, {}}, {});
                }),
                HasSubstr("5 rows for 6 tetrahedra"));
    EXPECT_THAT(bad_input([] {
                    return material_of_table(marbled(), {{1, 2, 3, 4, 5, 6, 7}, {}, {}}, {});
                }),
                HasSubstr("7 rows for 6 tetrahedra"));
    EXPECT_EQ(material_of_table(marbled(), {{1, 2, 3, 4, 5, 6}, {}, {}}, {}).youngs_modulus_pa[5], 6);
}

TEST(Total_mass, Density_times_volume_gives_it_back) {
    const TetMesh mesh = kuhn_box(2, 3, 4, {0.1, 0.2, 0.3});  // 0.006 m^3
    Material material = uniform_material(mesh, 1e4, {});
    set_total_mass(mesh, 3.0, material);
    for (const double density : material.density_kg_per_m3)
        EXPECT_NEAR(density, 500, 500 * 1e-12);  // rounding of a sum of 144 volumes
}

}  // namespace
}  // namespace knead::test
