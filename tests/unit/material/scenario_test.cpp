// SPDX-License-Identifier: Apache-2.0
#include "material/scenario.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using tools::scenario_material;

constexpr double kSide = 0.1;

bool is_soft(double modulus_pa) {
    return modulus_pa >= 2e3 && modulus_pa < 6e3;
}
bool is_stiff(double modulus_pa) {
    return modulus_pa >= 38e3 && modulus_pa < 42e3;
}

/// The paper's layouts in words of their own: name of the zone at a point of the unit cube; 'S' starts a
/// stiff zone, 's' a soft one.
std::string zone_at(int scenario, double x, double z, bool central) {
    const std::string column = x < 1.0 / 3 ? "left" : x < 2.0 / 3 ? "middle" : "right";
    const std::string layer = z < 1.0 / 3 ? "low" : z < 2.0 / 3 ? "middle" : "high";
    switch (scenario) {
        case 1:
            return z > 0.5 ? "Stop" : "sbottom";
        case 2:
            return z > 0.5 ? "stop" : "Sbottom";
        case 3:
            return (column == "middle" ? "s" : "S") + column;
        case 4:
            return (column == "middle" ? "S" : "s") + column;
        case 5:
            return (layer == "middle" ? "S" : "s") + layer;
        case 6:
            return (layer == "middle" ? "s" : "S") + layer;
        case 7:
            return central ? "scentre" : "Saround";
        default:
            return central ? "Scentre" : "saround";
    }
}

struct Count {
    int stiff = 0;
    int all = 0;
};

std::map<std::string, Count> count_by_zone(const TetMesh& mesh, const Material& material, int scenario) {
    std::map<std::string, Count> counts;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        Point middle = barycentre_m(mesh, t);
        for (double& coordinate : middle)
            coordinate /= kSide;
        const bool central = std::abs(middle[0] - 0.5) < 0.2 && std::abs(middle[1] - 0.5) < 0.2 &&
                             std::abs(middle[2] - 0.5) < 0.2;
        Count& count = counts[zone_at(scenario, middle[0], middle[2], central)];
        ++count.all;
        if (is_stiff(material.youngs_modulus_pa[t])) ++count.stiff;
    }
    return counts;
}

class EachScenario : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(EachScenario, Each_zone_holds_exactly_two_thirds_of_its_kind) {
    const auto [scenario, n] = GetParam();
    const TetMesh mesh = kuhn_cube(static_cast<std::uint32_t>(n), kSide);
    const Material material = scenario_material(mesh, scenario, 7, 0.3, 1000);
    for (const double modulus : material.youngs_modulus_pa)
        EXPECT_TRUE(is_soft(modulus) || is_stiff(modulus));
    for (const auto& [zone, count] : count_by_zone(mesh, material, scenario)) {
        const double majority = zone[0] == 'S' ? count.stiff : count.all - count.stiff;
        // Exact up to the rounding of the count to a whole number.
        EXPECT_LE(std::abs(majority - count.all * 2.0 / 3.0), 0.5) << zone << " of " << count.all;
    }
}

INSTANTIATE_TEST_SUITE_P(Paper, EachScenario,
                         testing::Combine(testing::Range(1, 9), testing::Values(6, 8, 10)));

TEST(Scenario, Nine_spreads_evenly_over_4_to_200_kilopascals) {
    const Material material = scenario_material(kuhn_cube(10), 9, 1, 0.3, 1000);
    double sum = 0;
    for (const double modulus : material.youngs_modulus_pa) {
        EXPECT_GE(modulus, 4e3);
        EXPECT_LT(modulus, 200e3);
        sum += modulus;
    }
    // Mean of 6,000 uniform values: 102 kPa with a standard error of 0.73 kPa; four of them.
    EXPECT_NEAR(sum / 6000, 102e3, 2.92e3);
}

TEST(Scenario, Same_seed_gives_the_same_values_and_another_seed_others) {
    const TetMesh mesh = kuhn_cube(6);
    const Material first = scenario_material(mesh, 1, 5, 0.3, 1000);
    EXPECT_EQ(first.youngs_modulus_pa, scenario_material(mesh, 1, 5, 0.3, 1000).youngs_modulus_pa);
    EXPECT_NE(first.youngs_modulus_pa, scenario_material(mesh, 1, 6, 0.3, 1000).youngs_modulus_pa);
}

TEST(Scenario, Layout_does_not_depend_on_where_the_box_stands) {
    const TetMesh mesh = kuhn_cube(6);
    TetMesh moved = mesh;
    for (Point& node : moved.nodes_m)
        node = {node[0] * 3 + 1, node[1] * 2 - 5, node[2] + 0.25};
    EXPECT_EQ(scenario_material(mesh, 7, 1, 0.3, 1000).youngs_modulus_pa,
              scenario_material(moved, 7, 1, 0.3, 1000).youngs_modulus_pa);
}

TEST(Scenario, Poissons_ratio_and_density_are_those_asked_for_and_values_are_raw) {
    const Material material = scenario_material(kuhn_cube(2), 3, 1, 0.45, 1200);
    EXPECT_EQ(material.poissons_ratio, std::vector<double>(48, 0.45));
    EXPECT_EQ(material.density_kg_per_m3, std::vector<double>(48, 1200));
    EXPECT_TRUE(material.bin_of_tetrahedron.empty());
}

TEST(Scenario, Numbers_outside_one_to_nine_are_refused) {
    EXPECT_THROW(scenario_material(kuhn_cube(1), 0, 1, 0.3, 1000), tools::ToolError);
    EXPECT_THROW(scenario_material(kuhn_cube(1), 10, 1, 0.3, 1000), tools::ToolError);
}

TEST(Scenario, Kuhn_cubes_of_the_tests_fill_their_box_without_inverted_tetrahedra) {
    const TetMesh mesh = kuhn_box(2, 3, 4, {0.1, 0.2, 0.3});
    double sum = 0;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        EXPECT_GT(signed_volume_m3(mesh, t), 0);
        sum += signed_volume_m3(mesh, t);
    }
    EXPECT_NEAR(sum, 0.006, 1e-15);
}

}  // namespace
}  // namespace knead::test
