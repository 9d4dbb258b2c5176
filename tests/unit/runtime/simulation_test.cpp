// SPDX-License-Identifier: Apache-2.0
#include "knead/runtime/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "unit/runtime/block_asset.h"

namespace knead::test {
namespace {

Asset press_cube() {
    return cube_asset(3, ToolShape::plate, ToolContact::bonded);
}

TEST(Simulation, made_from_memory_says_its_sizes_and_steps) {
    const Asset asset = press_cube();
    auto simulation = Simulation::create(asset);
    ASSERT_TRUE(simulation.ok());
    EXPECT_EQ(simulation.value().node_count(), 64u);
    EXPECT_EQ(simulation.value().tetrahedron_count(), asset.tetrahedra.size());
    Pose pose = simulation.value().tool_rest_pose();
    EXPECT_EQ(pose.position_m, (Vec3{0.05, 0.05, 0.1}));
    pose.position_m[2] -= 0.001;
    const StepResult result = simulation.value().step(pose, 1e-3);
    EXPECT_EQ(result.status, kStepOk);
    EXPECT_GT(result.force_n[2], 0);
    const auto node = asset.tools[0].nodes[0];
    EXPECT_NEAR(simulation.value().positions_m()[3 * node + 2], 0.099, 1e-9);
    simulation.value().reset();
    EXPECT_EQ(simulation.value().positions_m()[3 * node + 2], asset.nodes_m[node][2]);
}

TEST(Simulation, moves_between_owners) {
    auto made = Simulation::create(press_cube());
    ASSERT_TRUE(made.ok());
    Simulation first = std::move(made).value();
    const Simulation second = std::move(first);
    EXPECT_EQ(second.node_count(), 64u);
}

TEST(Simulation, from_an_asset_that_is_not_valid_is_refused) {
    Asset asset = press_cube();
    asset.tetrahedra[3][1] = 100000;
    const auto simulation = Simulation::create(asset);
    ASSERT_FALSE(simulation.ok());
    EXPECT_EQ(simulation.error().code, ErrorCode::invalid_data);
}

TEST(Simulation, of_matter_beyond_what_a_step_can_compute_with_is_refused_and_told_where) {
    for (const double e_pa : {1e35, 1e-35}) {
        Asset asset = press_cube();
        asset.palette.push_back({e_pa, 0.3, 1000});
        for (const std::size_t t : {2, 5, 7, 11})
            asset.palette_index[t] = 1;
        ASSERT_EQ(asset.palette.size(), 2u) << "or the index means another entry";
        const auto simulation = Simulation::create(asset);
        ASSERT_FALSE(simulation.ok()) << e_pa;
        EXPECT_EQ(simulation.error().code, ErrorCode::invalid_data);
        const std::string text = simulation.error().text();
        const std::string where =
            "4 of " + std::to_string(asset.tetrahedra.size()) + " tetrahedra (2, 5, 7) ";
        EXPECT_NE(text.find(where), std::string::npos) << text;
        EXPECT_NE(text.find(": stiffness "), std::string::npos) << text;
    }
}

TEST(Simulation, with_a_config_out_of_range_is_refused_and_told_which) {
    const double nan = std::nan("");
    const auto refused = [](const char* member, auto&& change) {
        SimulationConfig config;
        change(config);
        const auto simulation = Simulation::create(press_cube(), config);
        ASSERT_FALSE(simulation.ok()) << member;
        EXPECT_EQ(simulation.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(simulation.error().text().find(member), std::string::npos) << simulation.error().text();
    };
    refused("tools", [](auto& c) { c.tools = {1}; });
    refused("tools", [](auto& c) { c.tools = {0, 0}; });
    refused("tools", [](auto& c) { c.tools.clear(); });
    refused("expected_dt_s", [](auto& c) { c.expected_dt_s = 0; });
    refused("force_tolerance", [](auto& c) { c.force_tolerance = 0; });
    refused("force_tolerance", [nan](auto& c) { c.force_tolerance = nan; });
    refused("force_tolerance", [](auto& c) { c.force_tolerance = 0.2; });
    refused("max_solver_iterations", [](auto& c) { c.max_solver_iterations = 0; });
    refused("max_contact_passes", [](auto& c) { c.max_contact_passes = -1; });
    refused("max_linearisations", [](auto& c) { c.max_linearisations = -1; });
    refused("coupling_stiffness_n_per_m", [](auto& c) { c.coupling_stiffness_n_per_m = -1; });
    refused("coupling_stiffness_n_per_m",
            [](auto& c) { c.coupling_stiffness_n_per_m = std::numeric_limits<double>::infinity(); });
    refused("coupling_damping_n_s_per_m", [nan](auto& c) { c.coupling_damping_n_s_per_m = nan; });
    refused("coupling_damping_n_s_per_m", [](auto& c) { c.coupling_damping_n_s_per_m = 1; });
    refused("tool_mass_kg", [](auto& c) {
        c.coupling_stiffness_n_per_m = 100;
        c.tool_mass_kg = 0;
    });
}

TEST(Simulation, from_a_file_that_is_not_there_is_refused) {
    const auto simulation = Simulation::load("/nowhere/at/all.hdf");
    ASSERT_FALSE(simulation.ok());
    EXPECT_EQ(simulation.error().code, ErrorCode::io_error);
}

}  // namespace
}  // namespace knead::test
