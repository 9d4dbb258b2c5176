// SPDX-License-Identifier: Apache-2.0
#include "bench/exact_step.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>

#include "baseline/baseline.h"
#include "bench/motion.h"
#include "bench/scene.h"
#include "knead/formats/asset_object.h"
#include "reference/implicit_euler.h"
#include "reference/plate_press.h"

namespace knead::bench {
namespace {

using baseline::Baseline;

constexpr std::uint32_t kCells = 3;
constexpr double kDtS = 1e-3;

Point displacement(const Body& body, std::uint32_t node, const Pose& pose) {
    const Columns moved = body.predict(body.at_rest(), pose, kDtS) - body.rest_m;
    return {moved(0, node), moved(1, node), moved(2, node)};
}

/// Largest difference between exact step and reference along a motion of so many metres, over the largest
/// force.
double difference(const Asset& asset, double way_m, int steps) {
    const Body body = make_body(asset);
    const MaterialObject object = object_of(asset);
    tools::BodyForces forces;
    forces.gravity_m_per_s2 = asset.gravity_m_per_s2;
    forces.damping_per_s = asset.damping_per_s;
    tools::ImplicitEuler reference(object.mesh, object.material, forces);
    const tools::PlatePress nodes = tools::plate_press(object.mesh, 0);
    tools::MotionState reference_state = reference.rest();
    ExactStep exact(body);
    State state = body.at_rest();
    tools::PrescribedMotion prescribed = nodes.motion;
    double largest_n = 0;
    double worst_n = 0;
    for (int k = 1; k <= steps; ++k) {
        Pose pose = body.plate_rest;
        pose.position_m[0] += 0.3 * way_m * k / steps;
        pose.position_m[2] -= way_m * k / steps;
        for (std::size_t p = nodes.held_nodes.size(); p < prescribed.nodes.size(); ++p)
            prescribed.displacement_m[p] = displacement(body, prescribed.nodes[p], pose);
        const tools::MotionStep expected = reference.step(reference_state, prescribed, kDtS);
        reference_state = expected.state;
        const Point n = tools::force_on_plate_n(nodes, expected.solution);
        const Step found = exact.step(state, pose, kDtS);
        state = found.state;
        largest_n = std::max(largest_n, Eigen::Vector3d(n[0], n[1], n[2]).norm());
        worst_n = std::max(worst_n, (found.force_n - Eigen::Vector3d(n[0], n[1], n[2])).norm());
    }
    return worst_n / largest_n;
}

Asset cube(bool with_body_forces) {
    tools::Scene scene = press_scene();
    if (with_body_forces) {
        scene.gravity_m_per_s2 = {0, 1, -9.81};
        scene.damping_per_s = 3;
    }
    return bake_scene(scene, scenario_cube(kCells));
}

// What one linearisation leaves out is of second order in how far a step turns the tetrahedra: relative to
// the force 5.6e-7 was measured at 0.1 mm in ten steps, 3.1e-6 with the faster start that gravity gives, and
// in proportion to the way below; at 10 nm what is left is the reference's own residual of 1e-10.
constexpr double kTinyWayM = 1e-8;
constexpr double kTinyTolerance = 1e-8;
constexpr double kSlowWayM = 1e-4;
constexpr double kSlowTolerance = 1e-5;

TEST(ExactStep, Tiny_motion_gives_the_forces_of_the_reference) {
    EXPECT_LT(difference(cube(false), kTinyWayM, 10), kTinyTolerance);
}

TEST(ExactStep, Slow_motion_gives_the_forces_of_the_reference_with_and_without_gravity_and_damping) {
    EXPECT_LT(difference(cube(false), kSlowWayM, 10), kSlowTolerance);
    EXPECT_LT(difference(cube(true), kSlowWayM, 10), kSlowTolerance);
}

TEST(ExactStep, Deep_press_held_until_still_gives_the_static_force_of_the_reference) {
    const Asset asset = cube(false);
    const Body body = make_body(asset);
    const MaterialObject object = object_of(asset);
    const tools::PlatePress press = tools::plate_press(object.mesh, 0.2);
    const Point expected = tools::force_on_plate_n(
        press, tools::StaticProblem(object.mesh, object.material).solve(press.motion));
    ExactStep exact(body);
    State state = body.at_rest();
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (int k = 1; k <= 200; ++k) {
        Pose pose = body.plate_rest;
        pose.position_m[2] -= 0.2 * kSideM * std::min(1.0, k / 20.0);
        const Step step = exact.step(state, pose, 20e-3);  // the longest step: motion dies out quickly
        state = step.state;
        force = step.force_n;
    }
    constexpr double kStaticTolerance = 1e-7;  // both sides converge far below
    EXPECT_NEAR(force[0], expected[0], kStaticTolerance * expected[2]);
    EXPECT_NEAR(force[1], expected[1], kStaticTolerance * expected[2]);
    EXPECT_NEAR(force[2], expected[2], kStaticTolerance * expected[2]);
}

using LongMatrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using LongVector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

/// The equations of one step from rest, dense and in 64 bits of precision: rotations by Newton's iteration
/// for the polar decomposition, stiffness from the stress of unit displacements.
Eigen::Vector3d long_double_force(const Body& body, const Pose& pose, double dt_s) {
    using Matrix3 = Eigen::Matrix<long double, 3, 3>;
    const Eigen::Index size = body.rest_m.size();
    LongMatrix stiffness = LongMatrix::Zero(size, size);
    LongVector gradient = LongVector::Zero(size);
    const Columns predicted = body.predict(body.at_rest(), pose, dt_s);
    for (const Body::Element& e : body.elements) {
        Matrix3 f = Matrix3::Zero();
        for (int a = 0; a < 4; ++a)
            f += predicted.col(e.nodes[static_cast<std::size_t>(a)]).cast<long double>() *
                 e.shape_gradients.col(a).cast<long double>().transpose();
        Matrix3 r = f;
        for (int k = 0; k < 30; ++k)
            r = (0.5L * (r + Matrix3(r.inverse().transpose()))).eval();
        const Matrix3 local = r.transpose() * f - Matrix3::Identity();
        const auto stress = [&](const Matrix3& g) {
            return Matrix3(r *
                           (e.mu_pa * (g + g.transpose()) + e.lambda_pa * g.trace() * Matrix3::Identity()));
        };
        for (int row = 0; row < 12; ++row) {
            const Eigen::Index i = 3 * Eigen::Index{e.nodes[static_cast<std::size_t>(row / 3)]} + row % 3;
            const auto shape = [&](int k) { return e.shape_gradients.col(k / 3).cast<long double>().eval(); };
            gradient[i] += e.volume_m3 * stress(local).row(row % 3).dot(shape(row).transpose());
            for (int column = 0; column < 12; ++column) {
                const Eigen::Index j =
                    3 * Eigen::Index{e.nodes[static_cast<std::size_t>(column / 3)]} + column % 3;
                const Matrix3 unit = r.transpose().col(column % 3) * shape(column).transpose();
                stiffness(i, j) += e.volume_m3 * stress(unit).row(row % 3).dot(shape(row).transpose());
            }
        }
    }
    std::vector<Eigen::Index> unknowns;
    for (const std::uint32_t node : body.active)
        for (Eigen::Index k = 0; k < 3; ++k)
            unknowns.push_back(3 * Eigen::Index{node} + k);
    LongMatrix system = dt_s * dt_s * stiffness(unknowns, unknowns);
    for (std::size_t k = 0; k < unknowns.size(); ++k)
        system(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(k)) += body.mass_kg[unknowns[k] / 3];
    LongVector d = LongVector::Zero(size);
    const LongVector rhs = -dt_s * dt_s * gradient(unknowns);
    const LongVector solution = system.ldlt().solve(rhs);
    d(unknowns) = solution;
    const LongVector holding = gradient + stiffness * d;
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    for (const std::uint32_t node : body.plate)
        force -= holding.segment<3>(3 * Eigen::Index{node}).cast<double>() +
                 body.mass_kg[node] / (dt_s * dt_s) * (predicted.col(node) - body.rest_m.col(node));
    return force;
}

TEST(ExactStep, Forces_over_stiff_islands_and_paths_are_those_of_a_dense_solve_in_long_double) {
    constexpr double kDenseTolerance = 1e-6;  // of rounding the stress of 4e12 Pa in double
    for (const Layout layout : {Layout::islands, Layout::percolating})
        for (const double contrast : {1e3, 1e6, 1e9})
            for (const double dt_s : {1e-3, 10e-3}) {
                const Body body =
                    make_body(bake_scene(press_scene(), contrast_cube(4, 0.49, contrast, layout)));
                Pose pose = body.plate_rest;
                pose.position_m = {pose.position_m[0] + 1e-4, pose.position_m[1], pose.position_m[2] - 1e-3};
                const Eigen::Vector3d expected = long_double_force(body, pose, dt_s);
                ExactStep exact(body);
                const Eigen::Vector3d found = exact.step(body.at_rest(), pose, dt_s).force_n;
                EXPECT_LT((found - expected).norm(), kDenseTolerance * expected.norm())
                    << "contrast " << contrast << ", dt " << dt_s;
            }
}

TEST(Baseline, Each_step_stays_within_the_force_error_that_it_promises) {
    for (const bool with_body_forces : {false, true}) {
        const Body body = make_body(cube(with_body_forces));
        const Motion motion = press(0.1 * kSideM, 0.1, 0.1, 1.0);
        Baseline baseline(body);
        ExactStep exact(body);
        for (int k = 1; k <= 100; ++k) {
            const Pose pose = motion.pose(body.plate_rest, k * kDtS);
            const Eigen::Vector3d expected = exact.step(baseline.state(), pose, kDtS).force_n;
            const Eigen::Vector3d found = baseline.step(pose, kDtS);
            ASSERT_LT((found - expected).norm(), 1e-3 * std::max(0.2, expected.norm())) << "step " << k;
        }
    }
}

}  // namespace
}  // namespace knead::bench
