// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "unit/reference/contact_scene.h"

namespace knead::tools {
namespace {

using namespace contact_test;
using Eigen::Vector3d;

TEST(LinearisedContactStep, Is_the_converged_one_for_small_moves_from_rest) {
    const Scene scene(4);
    ContactProblem problem(scene.mesh, scene.material);
    constexpr double kDepthM = 1e-6;
    for (const ToolContact law : {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb}) {
        const ContactTool tool = scene.plate(law, kDepthM);
        const Vector3d exact = vec(problem.step(problem.rest(), scene.held, {tool}, kDtS).tools[0].force_n);
        const Vector3d linear =
            vec(problem.linearised_step(problem.rest(), scene.held, {tool}, kDtS).tools[0].force_n);
        constexpr double kTurning = 1e-3;  // of the force: strains of 1e-5 times its second order
        EXPECT_LT((exact - linear).norm(), kTurning * exact.norm());
        EXPECT_GT((exact - linear).norm(), 0);
    }
}

/// Where velocities alone lead.
std::vector<Point> ahead(const MotionState& from, double dt_s) {
    std::vector<Point> at = from.positions_m;
    for (std::size_t n = 0; n < at.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            at[n][axis] += dt_s * from.velocities_m_per_s[n][axis];
    return at;
}

/// One step with every node above a plane bonded, written down densely and separately: rotations by the polar
/// decomposition at the linearisation point, stiffness R K0 R^T, elastic force 2 mu (F - R) + lambda tr R.
/// @param target_m where held and bonded nodes must be
Vector3d dense_step_force(const Scene& scene, const MotionState& from, const std::vector<Point>& at,
                          const std::vector<Point>& target_m, const std::vector<bool>& held,
                          const std::vector<bool>& bonded) {
    const auto size = 3 * static_cast<Eigen::Index>(at.size());
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
    for (std::size_t t = 0; t < scene.mesh.tetrahedra.size(); ++t) {
        const Tetrahedron& nodes = scene.mesh.tetrahedra[t];
        Eigen::Matrix3d rest;
        Eigen::Matrix3d now;
        for (int k = 0; k < 3; ++k) {
            const auto n = nodes[static_cast<std::size_t>(k) + 1];
            rest.col(k) = vec(scene.mesh.nodes_m[n]) - vec(scene.mesh.nodes_m[nodes[0]]);
            now.col(k) = vec(at[n]) - vec(at[nodes[0]]);
        }
        const double volume = rest.determinant() / 6;
        const Eigen::Matrix3d f = now * rest.inverse();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> stretch(f.transpose() * f);
        const Eigen::Matrix3d r = f * stretch.operatorInverseSqrt();
        const double e = scene.material.youngs_modulus_pa[t];
        const double mu = e / 2.6;
        const double lambda = e * 0.3 / (1.3 * 0.4);
        const Eigen::Matrix3d stress = 2 * mu * (f - r) + lambda * ((r.transpose() * f).trace() - 3) * r;
        Eigen::Matrix<double, 3, 4> shape;
        shape.rightCols<3>() = rest.inverse().transpose();
        shape.col(0) = -shape.rightCols<3>().rowwise().sum();
        for (int b = 0; b < 4; ++b) {
            const Eigen::Index row = 3 * Eigen::Index(nodes[static_cast<std::size_t>(b)]);
            gradient.segment<3>(row) += volume * stress * shape.col(b);
            for (int a = 0; a < 4; ++a)
                for (int i = 0; i < 3; ++i) {
                    const Eigen::Matrix3d g = r.transpose() * Vector3d::Unit(i) * shape.col(a).transpose();
                    const Eigen::Matrix3d s =
                        mu * (g + g.transpose()) + lambda * g.trace() * Eigen::Matrix3d::Identity();
                    matrix.block<3, 1>(row, 3 * Eigen::Index(nodes[static_cast<std::size_t>(a)]) + i) +=
                        volume * r * s * shape.col(b);
                }
            for (int i = 0; i < 3; ++i)
                matrix(row + i, row + i) += 250 * volume / (kDtS * kDtS);  // a quarter of 1000 kg / m^3
            const auto n = nodes[static_cast<std::size_t>(b)];
            gradient.segment<3>(row) +=
                250 * volume / (kDtS * kDtS) *
                (vec(at[n]) - vec(from.positions_m[n]) - kDtS * vec(from.velocities_m_per_s[n]));
        }
    }
    Eigen::MatrixXd constrained = matrix;
    Eigen::VectorXd rhs = -gradient;
    for (std::size_t n = 0; n < at.size(); ++n) {
        if (!held[n] && !bonded[n]) continue;
        for (Eigen::Index k = 3 * Eigen::Index(n); k < 3 * Eigen::Index(n) + 3; ++k) {
            constrained.row(k).setZero();
            constrained(k, k) = 1;
        }
        rhs.segment<3>(3 * Eigen::Index(n)) = vec(target_m[n]) - vec(at[n]);
    }
    const Eigen::VectorXd all = gradient + matrix * constrained.fullPivLu().solve(rhs);
    Vector3d force = Vector3d::Zero();
    for (std::size_t n = 0; n < at.size(); ++n)
        if (bonded[n]) force -= all.segment<3>(3 * Eigen::Index(n));
    return force;
}

TEST(LinearisedContactStep, Solves_the_system_written_down_densely_at_a_turned_and_moving_state) {
    const Scene scene(2);
    ContactTool tool = scene.plate(ToolContact::sticking, 0.02);
    MotionState state{scene.mesh.nodes_m, std::vector<Point>(scene.mesh.nodes_m.size())};
    std::vector<bool> held(state.positions_m.size());
    std::vector<bool> touched(state.positions_m.size());
    for (const std::uint32_t n : scene.held.nodes)
        held[n] = true;
    for (std::size_t n = 0; n < held.size(); ++n)
        if (!held[n]) state.velocities_m_per_s[n] = {2 * scene.mesh.nodes_m[n][2] / kSideM, 0.3, -1};
    const std::vector<Point> at = ahead(state, kDtS);
    std::vector<Point> target = at;
    for (const std::uint32_t n : tool.nodes) {  // all of them touched before, at a place of their own
        touched[n] = true;
        const Point anchor{scene.mesh.nodes_m[n][0] - 0.05 + 0.003, scene.mesh.nodes_m[n][1] - 0.05, 0};
        tool.before.push_back({TouchMode::sticking, anchor});
        target[n] = {anchor[0] + 0.05, anchor[1] + 0.05, kSideM - 0.02};
    }
    ContactProblem problem(scene.mesh, scene.material);
    const ContactSolution solution = problem.linearised_step(state, scene.held, {tool}, kDtS);
    ASSERT_EQ(solution.touching, tool.nodes.size());
    const Vector3d expected = dense_step_force(scene, state, at, target, held, touched);
    EXPECT_LT((vec(solution.tools[0].force_n) - expected).norm(), kTolerance * expected.norm());
}

/// What slid before has its tangent plane there too, not where its anchor went with the tool.
TEST(LinearisedContactStep, Of_a_node_that_slid_takes_its_point_and_its_plane_where_its_velocity_leads) {
    const Scene scene(4);
    ContactProblem problem(scene.mesh, scene.material);
    ContactTool ball = scene.ball(ToolContact::coulomb, 0);
    MotionState state = problem.rest();
    constexpr int kDown = 20;
    for (int k = 1; k <= 2 * kDown; ++k) {  // down, then aside
        ball.pose.position_m[2] -= k <= kDown ? 0.01 / kDown : 0;
        ball.pose.position_m[0] += k > kDown ? 0.02 / kDown : 0;
        const ContactSolution solution = problem.step(state, scene.held, {ball}, kDtS);
        state = solution.state;
        ball.before = solution.tools[0].touches;
    }
    ASSERT_TRUE(std::any_of(ball.before.begin(), ball.before.end(),
                            [](const NodeTouch& touch) { return touch.mode == TouchMode::sliding; }));
    ball.pose.position_m[0] += 0.02 / kDown;
    const auto force = [&](const std::vector<Point>& at_m) {
        return vec(problem.linearised_step(state, scene.held, {ball}, kDtS, at_m).tools[0].force_n);
    };
    const Vector3d expected = force(ahead(state, kDtS));
    EXPECT_LT((force({}) - expected).norm(), kTolerance * expected.norm());
}

TEST(LinearisedContactStep, Fast_deep_press_with_sticking_lets_slide_what_can_neither_be_held_nor_let_go) {
    const Scene scene(3);
    ContactProblem problem(scene.mesh, scene.material);
    ContactTool tool = scene.plate(ToolContact::sticking, 0);
    MotionState state = problem.rest();
    std::size_t let_slide = 0;
    constexpr int kSteps = 30;
    constexpr double kStepS = 0.001;
    for (int k = 1; k <= kSteps; ++k) {
        const double share = static_cast<double>(k) / kSteps;
        tool.pose.position_m = {0.05 + 0.003 * share, 0.05 + 0.001 * std::sin(9 * share),
                                kSideM - 0.07 * std::sin(3.1416 * share)};
        // Linearised with what stuck at its anchor, for that makes it a hard one.
        std::vector<Point> at = ahead(state, kStepS);
        for (std::size_t i = 0; i < tool.before.size(); ++i)
            for (std::size_t axis = 0; axis < 3 && tool.before[i].mode != TouchMode::apart; ++axis)
                at[tool.nodes[i]][axis] = tool.pose.position_m[axis] + tool.before[i].anchor_m[axis];
        const ContactSolution solution = problem.linearised_step(state, scene.held, {tool}, kStepS, at);
        EXPECT_LE(solution.check.strongest_pull_n, solution.check.residual_limit_n);
        EXPECT_LE(solution.check.deepest_m, solution.check.gap_limit_m);
        let_slide += solution.let_slide;
        state = solution.state;
        tool.before = solution.tools[0].touches;
    }
    EXPECT_GT(let_slide, 0u);  // else this press does not show it any more
}

}  // namespace
}  // namespace knead::tools
