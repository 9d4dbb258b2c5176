// SPDX-License-Identifier: Apache-2.0
#include "reference/static_problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <random>

#include "common/error.h"
#include "support/kuhn_cube.h"
#include "unit/reference/uniform_material.h"

namespace knead::tools {
namespace {

using test::kuhn_cube;
using test::uniform_material;

constexpr double kYoungsModulusPa = 22000;
constexpr double kSideM = 0.1;
constexpr std::uint32_t kPatchCells = 4;
// Positions in metres: Newton stops at 1e-10 of the forces, which the stiffness turns into about 1e-11 of the
// size.
constexpr double kPositionToleranceM = 1e-10 * kSideM;
constexpr double kForceTolerance = 1e-9;  // relative: the residual of 1e-10, with room for sums over nodes

double uniform(std::mt19937_64& bits) {
    return static_cast<double>(bits() >> 11) * 0x1p-52 - 1;
}

bool on_boundary(const Point& point) {
    return std::any_of(point.begin(), point.end(), [](double x) { return x < 1e-12 || x > kSideM - 1e-12; });
}

/// A cube whose inner nodes are shifted by up to 0.15 of a cell.
TetMesh jittered_cube() {
    TetMesh mesh = kuhn_cube(kPatchCells);
    std::mt19937_64 bits(3);
    for (Point& node : mesh.nodes_m) {
        if (on_boundary(node)) continue;
        for (double& x : node)
            x += 0.15 * kSideM / kPatchCells * uniform(bits);
    }
    return mesh;
}

using Motion = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Moves every boundary node as `motion` says.
PrescribedMotion boundary_motion(const TetMesh& mesh, const Motion& motion) {
    PrescribedMotion prescribed;
    for (std::uint32_t n = 0; n < mesh.nodes_m.size(); ++n) {
        if (!on_boundary(mesh.nodes_m[n])) continue;
        const Eigen::Vector3d at(mesh.nodes_m[n].data());
        const Eigen::Vector3d u = motion(at) - at;
        prescribed.nodes.push_back(n);
        prescribed.displacement_m.push_back({u.x(), u.y(), u.z()});
    }
    return prescribed;
}

/// Largest distance between the positions found and those of the motion.
double largest_error_m(const TetMesh& mesh, const StaticSolution& solution, const Motion& motion) {
    double largest = 0;
    for (std::size_t n = 0; n < mesh.nodes_m.size(); ++n)
        largest = std::max(largest, (Eigen::Vector3d(solution.positions_m[n].data()) -
                                     motion(Eigen::Vector3d(mesh.nodes_m[n].data())))
                                        .norm());
    return largest;
}

/// Sum of force x lever over the holders, F-wise: for a homogeneous state equal to -volume * P.
Eigen::Matrix3d moment_of_reactions(const TetMesh& mesh, const PrescribedMotion& prescribed,
                                    const StaticSolution& solution) {
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < prescribed.nodes.size(); ++k)
        moment += Eigen::Vector3d(solution.reactions_n[k].data()) *
                  Eigen::Vector3d(mesh.nodes_m[prescribed.nodes[k]].data()).transpose();
    return moment;
}

double lame_mu(double nu) {
    return kYoungsModulusPa / (2 * (1 + nu));
}
double lame_lambda(double nu) {
    return kYoungsModulusPa * nu / ((1 + nu) * (1 - 2 * nu));
}

TEST(StaticProblem, Affine_finite_boundary_motion_of_a_homogeneous_body_gives_the_affine_field_and_stress) {
    const TetMesh mesh = jittered_cube();
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -0.5).normalized()).toRotationMatrix();
    Eigen::Matrix3d stretch;
    stretch << 1.10, 0.03, -0.02, 0.03, 0.93, 0.04, -0.02, 0.04,
        1.02;  // symmetric: R of turn * stretch is turn
    for (const double nu : {0.0, 0.3, 0.45}) {
        const Motion motion = [&](const Eigen::Vector3d& x) {
            return Eigen::Vector3d(turn * stretch * x + Eigen::Vector3d(0.01, 0.02, -0.03));
        };
        const PrescribedMotion prescribed = boundary_motion(mesh, motion);
        StaticProblem problem(mesh, uniform_material(mesh, kYoungsModulusPa, nu));
        const StaticSolution solution = problem.solve(prescribed);
        EXPECT_LT(largest_error_m(mesh, solution, motion), kPositionToleranceM);

        const Eigen::Matrix3d stress =
            turn * (2 * lame_mu(nu) * (stretch - Eigen::Matrix3d::Identity()) +
                    lame_lambda(nu) * (stretch.trace() - 3) * Eigen::Matrix3d::Identity());
        const Eigen::Matrix3d expected = -std::pow(kSideM, 3) * stress;
        const Eigen::Matrix3d found = moment_of_reactions(mesh, prescribed, solution);
        EXPECT_LT((found - expected).norm(), kForceTolerance * expected.norm());
    }
}

TEST(StaticProblem, Affine_small_boundary_motion_solved_linearly_gives_hookes_law) {
    const TetMesh mesh = jittered_cube();
    constexpr double kNu = 0.3;
    Eigen::Matrix3d gradient;
    gradient << 1e-3, 2e-3, -1e-3, 5e-4, -2e-3, 3e-3, 0, 1e-3, 1.5e-3;
    const Motion motion = [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(x + gradient * x); };
    const PrescribedMotion prescribed = boundary_motion(mesh, motion);
    StaticProblem problem(mesh, uniform_material(mesh, kYoungsModulusPa, kNu));
    const StaticSolution solution = problem.solve_linear(prescribed);
    EXPECT_LT(largest_error_m(mesh, solution, motion), kPositionToleranceM);

    const Eigen::Matrix3d strain = (gradient + gradient.transpose()) / 2;
    const Eigen::Matrix3d stress =
        2 * lame_mu(kNu) * strain + lame_lambda(kNu) * strain.trace() * Eigen::Matrix3d::Identity();
    const Eigen::Matrix3d expected = -std::pow(kSideM, 3) * stress;
    EXPECT_LT((moment_of_reactions(mesh, prescribed, solution) - expected).norm(),
              kForceTolerance * expected.norm());
    EXPECT_NEAR(solution.energy_j, std::pow(kSideM, 3) / 2 * (stress.cwiseProduct(strain)).sum(),
                kForceTolerance * solution.energy_j);
}

TEST(StaticProblem, Force_on_one_face_of_a_stretched_block_is_stress_times_area) {
    const TetMesh mesh = jittered_cube();
    constexpr double kNu = 0.3;
    constexpr double kStretch = 1.2;
    const Motion motion = [](const Eigen::Vector3d& x) {
        return Eigen::Vector3d(x.x(), x.y(), kStretch * x.z());
    };
    const PrescribedMotion prescribed = boundary_motion(mesh, motion);
    StaticProblem problem(mesh, uniform_material(mesh, kYoungsModulusPa, kNu));
    const StaticSolution solution = problem.solve(prescribed);
    // The sides are held too: a top node on an edge takes part of the sideways push, none of the pull along z
    // (no stress zx, zy), so the pull on the top nodes is that of the face.
    double pull_n = 0;
    for (std::size_t k = 0; k < prescribed.nodes.size(); ++k)
        if (mesh.nodes_m[prescribed.nodes[k]][2] > kSideM - 1e-12) pull_n -= solution.reactions_n[k][2];
    const double expected = (2 * lame_mu(kNu) + lame_lambda(kNu)) * (kStretch - 1) * kSideM * kSideM;
    EXPECT_NEAR(pull_n, expected, kForceTolerance * expected);
}

TEST(StaticProblem, Rigid_motion_of_a_heterogeneous_body_gives_no_force) {
    const TetMesh mesh = jittered_cube();
    Material material = uniform_material(mesh, kYoungsModulusPa);
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        material.youngs_modulus_pa[t] *= t % 3 == 0 ? 10 : 1;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(2.8, Eigen::Vector3d(0.3, -1, 2).normalized()).toRotationMatrix();
    const Motion motion = [&](const Eigen::Vector3d& x) {
        return Eigen::Vector3d(turn * x + Eigen::Vector3d(0.1, -0.2, 0.3));
    };
    const PrescribedMotion prescribed = boundary_motion(mesh, motion);
    StaticProblem problem(mesh, material);
    const StaticSolution solution = problem.solve(prescribed);
    EXPECT_LT(largest_error_m(mesh, solution, motion), kPositionToleranceM);
    double largest_n = 0;
    for (const Point& force : solution.reactions_n)
        for (const double component : force)
            largest_n = std::max(largest_n, std::abs(component));
    EXPECT_LT(largest_n, kForceTolerance * kYoungsModulusPa * kSideM * kSideM);
}

/// A heterogeneous cube, its material and a press with a sideways part.
struct Case {
    TetMesh mesh = jittered_cube();
    Material material;
    PrescribedMotion prescribed;

    Case() {
        std::mt19937_64 bits(5);
        material = uniform_material(mesh, kYoungsModulusPa);
        for (double& e : material.youngs_modulus_pa)
            e *= 1 + 0.9 * uniform(bits);
        for (double& nu : material.poissons_ratio)
            nu = 0.3 + 0.15 * uniform(bits);
        for (std::uint32_t n = 0; n < mesh.nodes_m.size(); ++n) {
            const double z = mesh.nodes_m[n][2];
            if (z > 1e-12 && z < kSideM - 1e-12) continue;
            prescribed.nodes.push_back(n);
            prescribed.displacement_m.push_back(z > 1e-12 ? Point{0.01, 0, -0.015} : Point{0, 0, 0});
        }
    }
};

TEST(StaticProblem, Forces_balance_and_stay_the_same_when_nodes_and_tetrahedra_are_renumbered) {
    Case original;
    const StaticSolution expected =
        StaticProblem(original.mesh, original.material).solve(original.prescribed);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double scale_n = 0;
    for (const Point& force : expected.reactions_n) {
        sum += Eigen::Vector3d(force.data());
        scale_n += Eigen::Vector3d(force.data()).norm();
    }
    EXPECT_LT(sum.norm(), kForceTolerance * scale_n);

    // A stride that shares no factor with the counts (125 nodes, 384 tetrahedra) visits every number once.
    const auto shuffled = [](std::size_t count, std::size_t stride) {
        std::vector<std::uint32_t> order(count);
        for (std::size_t k = 0; k < count; ++k)
            order[k] = static_cast<std::uint32_t>(k * stride % count);
        return order;
    };
    const std::vector<std::uint32_t> new_node = shuffled(original.mesh.nodes_m.size(), 47);
    const std::vector<std::uint32_t> old_tetrahedron = shuffled(original.mesh.tetrahedra.size(), 101);
    Case renumbered = original;
    for (std::size_t n = 0; n < new_node.size(); ++n)
        renumbered.mesh.nodes_m[new_node[n]] = original.mesh.nodes_m[n];
    for (std::size_t t = 0; t < old_tetrahedron.size(); ++t) {
        const std::size_t from = old_tetrahedron[t];
        const Tetrahedron& nodes = original.mesh.tetrahedra[from];
        // An even renumbering inside the tetrahedron keeps its orientation.
        renumbered.mesh.tetrahedra[t] = {new_node[nodes[1]], new_node[nodes[2]], new_node[nodes[0]],
                                         new_node[nodes[3]]};
        renumbered.material.youngs_modulus_pa[t] = original.material.youngs_modulus_pa[from];
        renumbered.material.poissons_ratio[t] = original.material.poissons_ratio[from];
    }
    for (std::uint32_t& node : renumbered.prescribed.nodes)
        node = new_node[node];
    const StaticSolution found =
        StaticProblem(renumbered.mesh, renumbered.material).solve(renumbered.prescribed);
    for (std::size_t k = 0; k < expected.reactions_n.size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(found.reactions_n[k][axis], expected.reactions_n[k][axis], kForceTolerance * scale_n);
    for (std::size_t n = 0; n < new_node.size(); ++n)
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(found.positions_m[new_node[n]][axis], expected.positions_m[n][axis],
                        kPositionToleranceM);
}

TEST(StaticProblem, Reactions_are_the_energy_s_derivative_to_the_prescribed_displacements) {
    Case base;
    StaticProblem problem(base.mesh, base.material);
    const StaticSolution solution = problem.solve(base.prescribed);
    constexpr double kNudgeM = 1e-5;
    constexpr double kNudgeTolerance = 1e-5;  // second order in the nudge over the cell
    for (const std::size_t axis : {std::size_t{0}, std::size_t{2}}) {
        PrescribedMotion above = base.prescribed;
        PrescribedMotion below = base.prescribed;
        double push_n = 0;
        for (std::size_t k = 0; k < above.nodes.size(); ++k) {
            if (base.mesh.nodes_m[above.nodes[k]][2] < kSideM / 2) continue;
            above.displacement_m[k][axis] += kNudgeM;
            below.displacement_m[k][axis] -= kNudgeM;
            push_n += solution.reactions_n[k][axis];
        }
        const double slope = (problem.solve(above).energy_j - problem.solve(below).energy_j) / (2 * kNudgeM);
        EXPECT_NEAR(push_n, -slope, kNudgeTolerance * std::abs(slope));
    }
}

TEST(StaticProblem, Tetrahedron_started_inside_out_recovers_its_rest_shape) {
    TetMesh mesh;
    mesh.nodes_m = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.3, 1}};
    mesh.tetrahedra = {{0, 1, 2, 3}};
    StaticProblem problem(mesh, uniform_material(mesh, kYoungsModulusPa));
    PrescribedMotion held;
    held.nodes = {0, 1, 2};
    held.displacement_m.assign(3, Point{0, 0, 0});
    for (const double depth : {-0.1, -0.6, -1.5}) {
        std::vector<Point> start = mesh.nodes_m;
        start[3] = {0.25, 0.25, depth};
        const StaticSolution solution = problem.solve(held, start);
        for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(solution.positions_m[3][axis], mesh.nodes_m[3][axis], 1e-9) << depth;
        EXPECT_GT(solution.iterations, 1) << "the start must be used";
    }
}

TEST(StaticProblem, Cube_started_with_inner_tetrahedra_inside_out_recovers_its_rest_shape) {
    Case tangled;
    std::mt19937_64 bits(9);
    std::vector<Point> start = tangled.mesh.nodes_m;
    for (Point& node : start)
        if (!on_boundary(node))
            for (double& x : node)
                x += 0.8 * kSideM / kPatchCells * uniform(bits);
    TetMesh moved = tangled.mesh;
    moved.nodes_m = start;
    std::size_t inside_out = 0;
    for (std::size_t t = 0; t < moved.tetrahedra.size(); ++t)
        inside_out += signed_volume_m3(moved, t) < 0;
    ASSERT_GT(inside_out, 20u);

    const PrescribedMotion held =
        boundary_motion(tangled.mesh, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(x); });
    StaticProblem problem(tangled.mesh, tangled.material);
    const StaticSolution solution = problem.solve(held, start);
    EXPECT_LT(
        largest_error_m(tangled.mesh, solution, [](const Eigen::Vector3d& x) { return Eigen::Vector3d(x); }),
        kPositionToleranceM * 10);  // the forces vanish at rest: rounding noise decides when Newton stops
}

TEST(StaticProblem, Half_crushed_cube_still_converges) {
    Case crushed;
    for (Point& u : crushed.prescribed.displacement_m)
        u = {0, 0, u[2] < 0 ? -0.5 * kSideM : 0};
    StaticProblem problem(crushed.mesh, crushed.material);
    const StaticSolution solution = problem.solve(crushed.prescribed);
    EXPECT_LE(solution.residual_n, 1e-10 * solution.force_scale_n);
}

TEST(StaticProblem, Motion_too_long_for_the_iterations_allowed_is_cut_into_load_steps_with_the_same_end) {
    Case base;
    StaticProblem problem(base.mesh, base.material);
    const StaticSolution whole = problem.solve(base.prescribed);
    EXPECT_EQ(whole.load_steps, 1);
    NewtonLimits limits;
    limits.max_iterations = 2;
    const StaticSolution cut = problem.solve(base.prescribed, {}, limits);
    EXPECT_GT(cut.load_steps, 1);
    EXPECT_NEAR(cut.energy_j, whole.energy_j, kForceTolerance * whole.energy_j);

    NewtonLimits asked;
    asked.load_steps = 3;
    const StaticSolution parts = problem.solve(base.prescribed, {}, asked);
    EXPECT_EQ(parts.load_steps, 3);
    EXPECT_NEAR(parts.energy_j, whole.energy_j, kForceTolerance * whole.energy_j);
}

/// The message and exit code of what `call` throws.
std::pair<ExitCode, std::string> failure(const std::function<void()>& call) {
    try {
        call();
    } catch (const ToolError& error) {
        return {error.code(), error.what()};
    }
    return {ExitCode::done, "nothing was thrown"};
}

TEST(StaticProblem, Object_that_is_not_held_is_refused_with_the_numbers) {
    const TetMesh mesh = kuhn_cube(1);
    StaticProblem problem(mesh, uniform_material(mesh, kYoungsModulusPa));
    PrescribedMotion one_node;
    one_node.nodes = {0};
    one_node.displacement_m = {{0, 0, 0.01}};
    const auto [code, message] = failure([&] { (void)problem.solve_linear(one_node); });
    EXPECT_EQ(code, ExitCode::no_valid_result) << message;
    EXPECT_THAT(message, testing::HasSubstr("21 free unknowns, 1 nodes prescribed"));
}

TEST(StaticProblem, Solve_that_runs_out_of_iterations_is_refused_with_the_numbers) {
    Case base;
    StaticProblem problem(base.mesh, base.material);
    NewtonLimits limits;
    limits.max_iterations = 1;
    limits.max_load_steps = 1;
    const auto [code, message] = failure([&] { (void)problem.solve(base.prescribed, {}, limits); });
    EXPECT_EQ(code, ExitCode::no_valid_result);
    EXPECT_THAT(message, testing::HasSubstr("residual of"));
    EXPECT_THAT(message, testing::HasSubstr("2 linear solves"));
}

TEST(StaticProblem, Motion_that_breaks_its_invariants_is_refused) {
    const TetMesh mesh = kuhn_cube(1);
    StaticProblem problem(mesh, uniform_material(mesh, kYoungsModulusPa));
    const std::map<std::string, PrescribedMotion> bad{
        {"node 8 of 8 does not exist", {{8}, {{0, 0, 0}}, {}}},
        {"node 1 is given twice", {{1, 1}, {{0, 0, 0}, {0, 0, 0}}, {}}},
        {"displacement of node 1 is not finite", {{1}, {{0, std::nan(""), 0}}, {}}},
        {"0 displacements for 1 nodes", {{1}, {}, {}}},
        {"2 axes for 1 nodes", {{1}, {{0, 0, 0}}, {7, 7}}},
        {"node 1 has axes 0", {{1}, {{0, 0, 0}}, {0}}},
        {"node 1 has axes 8", {{1}, {{0, 0, 0}}, {8}}},
    };
    for (const auto& [expected, motion] : bad) {
        const auto [code, message] = failure([&, m = motion] { (void)problem.solve(m); });
        EXPECT_EQ(code, ExitCode::bad_input) << expected;
        EXPECT_THAT(message, testing::HasSubstr(expected));
    }
    const auto [code, message] = failure([&] { (void)problem.solve({}, {{0, 0, 0}}); });
    EXPECT_EQ(code, ExitCode::bad_input);
    EXPECT_THAT(message, testing::HasSubstr("1 entries for 8 nodes"));
    NewtonLimits none;
    none.load_steps = 0;
    EXPECT_EQ(failure([&] { (void)problem.solve({}, {}, none); }).first, ExitCode::bad_input);
}

TEST(StaticProblem, Material_that_breaks_its_invariants_is_refused) {
    const TetMesh mesh = kuhn_cube(1);
    Material material = uniform_material(mesh, kYoungsModulusPa);
    material.youngs_modulus_pa.pop_back();
    const auto [code, message] = failure([&] { StaticProblem(mesh, material); });
    EXPECT_EQ(code, ExitCode::bad_input) << message;
}

}  // namespace
}  // namespace knead::tools
