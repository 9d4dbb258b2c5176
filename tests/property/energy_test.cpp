// SPDX-License-Identifier: Apache-2.0
// What the runtime answers at rest must follow from one energy: forces are its derivative, stiffness the
// derivative of the forces, and therefore symmetric. The energy is the reference solver's, which shares no
// code with the runtime.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <optional>

#include "property/held_press.h"
#include "property/reference_energy.h"

namespace knead::test {
namespace {

constexpr double kStep_m = 1e-4;    // of finite differences: a thousandth of the object
constexpr double kStill_m = 1e-12;  // per step of 20 ms
// Central differences over 1e-3 of the size: their error is of the order of its square, times a few for the
// curvature of the force under a press of a tenth.
constexpr double kEnergyTolerance = 1e-4;
constexpr double kReciprocityTolerance = 1e-4;
constexpr double kStiffnessTolerance = 5e-3;  // local_model() stops at about 1e-3 of the stiffness

/// any_body() in peace: no gravity; with a second bonded tool on its right side.
Asset two_handled_body(std::uint64_t seed) {
    Asset asset = any_body(seed);
    asset.gravity_m_per_s2 = {};
    asset.damping_per_s = 20;  // comes to rest sooner
    ToolSet side = asset.tools[0];
    side.name = "side";
    side.nodes = free_nodes(asset, [](const Point& p) { return p[0] > 0.05 && p[2] > 0.02 && p[2] < 0.06; });
    side.rest_position_m = asset.nodes_m[side.nodes.front()];
    asset.tools.push_back(side);
    return asset;
}

class HeldBody {
  public:
    explicit HeldBody(std::uint64_t seed) : asset(two_handled_body(seed)), config(exact_config(20e-3)) {
        config.tools = {0, 1};
        config.with_torque = false;
        config.with_local_model = true;
        simulation.emplace(simulation_of(asset, config));
        const Vector3d press(0.002, -0.001, -0.006);
        poses = {moved(simulation->tool_rest_pose(0), press),
                 moved(simulation->tool_rest_pose(1), Vector3d(-0.003, 0.001, 0))};
    }

    Rest at(std::size_t tool, const Vector3d& shift_m) {
        std::vector<Pose> there = poses;
        there[tool] = moved(there[tool], shift_m);
        return settle(*simulation, there, kStill_m);
    }

    Asset asset;
    SimulationConfig config;
    std::optional<Simulation> simulation;
    std::vector<Pose> poses;
};

RC_GTEST_PROP(Energy, Force_at_rest_is_minus_the_derivative_of_the_energy, ()) {
    HeldBody body(static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000)));
    const auto tool = static_cast<std::size_t>(*rc::gen::inRange(0, 2));
    const Vector3d force = body.at(tool, Vector3d::Zero()).forces_n[tool];
    for (int axis = 0; axis < 3; ++axis) {
        const Vector3d shift = kStep_m * Vector3d::Unit(axis);
        const double ahead = elastic_energy_j(body.asset, body.at(tool, shift).positions_m);
        const double behind = elastic_energy_j(body.asset, body.at(tool, -shift).positions_m);
        RC_ASSERT(std::abs(force[axis] + (ahead - behind) / (2 * kStep_m)) < kEnergyTolerance * force.norm());
    }
}

RC_GTEST_PROP(Energy, Work_of_one_tool_on_the_other_is_mutual, ()) {
    HeldBody body(static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000)));
    // Column: which tool and axis moves; rows: the forces on both tools.
    Eigen::Matrix<double, 6, 6> stiffness;
    for (int column = 0; column < 6; ++column) {
        const auto tool = static_cast<std::size_t>(column / 3);
        const Vector3d shift = kStep_m * Vector3d::Unit(column % 3);
        const Rest ahead = body.at(tool, shift), behind = body.at(tool, -shift);
        for (int row = 0; row < 6; ++row) {
            const auto other = static_cast<std::size_t>(row / 3);
            stiffness(row, column) =
                -(ahead.forces_n[other][row % 3] - behind.forces_n[other][row % 3]) / (2 * kStep_m);
        }
    }
    const double scale = stiffness.cwiseAbs().maxCoeff();
    RC_ASSERT((stiffness - stiffness.transpose()).cwiseAbs().maxCoeff() < kReciprocityTolerance * scale);
    RC_ASSERT(stiffness.topRightCorner(3, 3).cwiseAbs().maxCoeff() >
              0.01 * scale);  // they do feel each other
}

RC_GTEST_PROP(Energy, Local_stiffness_is_symmetric_and_minus_the_derivative_of_the_force, ()) {
    HeldBody body(static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000)));
    // Unloaded: under load the change of rotations, which K leaves out and forces do not, would be of the
    // order of the strain.
    body.poses = {body.simulation->tool_rest_pose(0), body.simulation->tool_rest_pose(1)};
    (void)body.at(0, Vector3d::Zero());
    LocalModel model;
    for (int call = 0; call == 0 || (!model.converged && call < 100); ++call)
        RC_ASSERT(body.simulation->local_model(0, model));
    RC_ASSERT(model.converged);
    Matrix3d found, expected;
    for (int axis = 0; axis < 3; ++axis) {
        const Vector3d shift = kStep_m * Vector3d::Unit(axis);
        expected.col(axis) =
            -(body.at(0, shift).forces_n[0] - body.at(0, -shift).forces_n[0]) / (2 * kStep_m);
        for (int row = 0; row < 3; ++row)
            found(row, axis) = model.stiffness[static_cast<std::size_t>(6 * row + axis)];
    }
    const double scale = expected.cwiseAbs().maxCoeff();
    RC_ASSERT((found - found.transpose()).cwiseAbs().maxCoeff() < 1e-12 * scale);  // by construction
    RC_ASSERT((found - expected).cwiseAbs().maxCoeff() < kStiffnessTolerance * scale);
}

}  // namespace
}  // namespace knead::test
