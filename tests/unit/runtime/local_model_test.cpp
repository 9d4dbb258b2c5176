// SPDX-License-Identifier: Apache-2.0
// The linear view of an object against dense matrices of the reference's elements.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstring>

#include "knead/formats/asset_object.h"
#include "knead/runtime/simulation.h"
#include "reference/elastic_body.h"
#include "unit/runtime/block_asset.h"
#include "unit/runtime/watched_calls.h"

namespace knead::test {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Conjugate gradients end at a relative error of 1e-3 of a stiffness; twice that off the diagonal.
constexpr double kStiffnessTolerance = 2e-3;
/// Mass and damping come from differences of stiffnesses, and energies that are first order in the error.
constexpr double kFitTolerance = 3e-2;
/// A matrix that is its own transpose by construction.
constexpr double kExact = 1e-14;
/// A direction that feels less than this share of the stiffest is taken for one that feels nothing; for a
/// rotation, that is an arm of a millimetre.
constexpr double kNothing = 1e-6;
/// Rounding of float sums over a mesh of this size, relative to the largest entry.
constexpr double kFloatTolerance = 1e-5;
/// The time scale of the fit (docs/simulation.md, "The linear view").
constexpr double kFitted_s = 4e-3;

Matrix6d to_eigen(const Mat6& m) {
    return Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.data());
}

Pose pose_at(const Asset& asset, const Vector3d& move_m, const Vector3d& turn = Vector3d::Zero()) {
    Pose pose{asset.tools[0].rest_position_m, asset.tools[0].rest_orientation_wxyz};
    for (int k = 0; k < 3; ++k)
        pose.position_m[static_cast<std::size_t>(k)] += move_m[k];
    if (turn.norm() > 0) {
        const auto& q = pose.orientation_wxyz;
        const Eigen::Quaterniond turned =
            Eigen::AngleAxisd(turn.norm(), turn.normalized()) * Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
        pose.orientation_wxyz = {turned.w(), turned.x(), turned.y(), turned.z()};
    }
    return pose;
}

SimulationConfig views(bool with_torque, Arithmetic arithmetic = Arithmetic::float64) {
    SimulationConfig config;
    config.with_local_model = true;
    config.with_torque = with_torque;
    config.arithmetic = arithmetic;
    config.expected_dt_s = 8e-3;
    config.force_tolerance = 1e-6;
    return config;
}

Simulation made(const Asset& asset, const SimulationConfig& config) {
    Result<Simulation> simulation = Simulation::create(asset, config);
    EXPECT_TRUE(simulation) << simulation.error().message;
    return std::move(simulation).value();
}

/// Moves there in 20 steps and holds it until the object is at rest.
void settle(Simulation& simulation, const Asset& asset, const Vector3d& move_m,
            const Vector3d& turn = Vector3d::Zero(), int hold = 100) {
    for (int i = 1; i <= 20 + hold; ++i) {
        const double share = std::min(1.0, i / 20.0);
        simulation.step(pose_at(asset, share * move_m, share * turn), 8e-3);
    }
}

LocalModel view(Simulation& simulation) {
    LocalModel model;
    // What one call leaves undone, another does.
    for (int k = 0; k < 10; ++k)
        EXPECT_TRUE(simulation.local_model(0, model));
    EXPECT_TRUE(model.converged);
    return model;
}

/// The object of an asset in dense matrices, at the runtime's positions.
class Oracle {
  public:
    Oracle(const Asset& asset, Simulation& simulation) : asset_(asset), body_(make_body(asset)) {
        const double* x = simulation.positions_m();
        positions_ = Eigen::Map<const VectorXd>(x, 3 * static_cast<Eigen::Index>(asset.nodes_m.size()));
        const Eigen::Index n = positions_.size();
        stiffness_ = MatrixXd::Zero(n, n);
        for (std::size_t t = 0; t < body_.tetrahedron_count(); ++t) {
            const tools::Matrix12d k =
                body_.stiffness_n_per_m(t, positions_, tools::Curvature::rotation_frozen);
            for (int a = 0; a < 4; ++a) {
                for (int b = 0; b < 4; ++b) {
                    stiffness_.block<3, 3>(
                        tools::first_unknown(body_.nodes_of(t)[static_cast<std::size_t>(a)]),
                        tools::first_unknown(body_.nodes_of(t)[static_cast<std::size_t>(b)])) +=
                        k.block<3, 3>(3 * a, 3 * b);
                }
            }
        }
        mass_ = VectorXd::Zero(n);
        for (Eigen::Index i = 0; i < n; ++i)
            mass_[i] = body_.lumped_mass_kg()[body_.lumped_mass_kg().size() == n ? i : i / 3];
    }

    /// The nodes that the tool holds: in all directions (normals empty), or along a normal each.
    void hold(const std::vector<std::uint32_t>& nodes, const std::vector<Vector3d>& normals,
              const Vector3d& origin) {
        const Eigen::Index free = 3 * asset_.free_node_count;
        moves_ = MatrixXd::Zero(positions_.size(), 6);
        std::vector<VectorXd> columns;
        std::vector<bool> is_held(asset_.nodes_m.size(), false);
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            const Eigen::Index at = 3 * Eigen::Index{nodes[k]};
            is_held[nodes[k]] = true;
            const Matrix3d held =
                normals.empty() ? Matrix3d::Identity() : Matrix3d(normals[k] * normals[k].transpose());
            const Vector3d arm = positions_.segment<3>(at) - origin;
            for (int c = 0; c < 3; ++c) {
                moves_.block<3, 1>(at, c) = held * Vector3d::Unit(c);
                moves_.block<3, 1>(at, 3 + c) = held * Vector3d::Unit(c).cross(arm);
            }
            if (normals.empty()) continue;
            const Eigen::FullPivLU<Matrix3d> lu(held);
            const MatrixXd tangents = lu.kernel();
            for (int c = 0; c < 2; ++c) {
                VectorXd column = VectorXd::Zero(positions_.size());
                column.segment<3>(at) = tangents.col(c);
                columns.push_back(column);
            }
        }
        for (Eigen::Index i = 0; i < free; ++i) {
            if (!is_held[static_cast<std::size_t>(i / 3)])
                columns.push_back(VectorXd::Unit(positions_.size(), i));
        }
        follows_ = MatrixXd(positions_.size(), static_cast<Eigen::Index>(columns.size()));
        for (std::size_t k = 0; k < columns.size(); ++k)
            follows_.col(static_cast<Eigen::Index>(k)) = columns[k];
    }

    /// What the tool feels of motions that grow as exp(s t), damping c: K + (s^2 + c s) M condensed.
    [[nodiscard]] Matrix6d felt(double s, double c = 0) const {
        MatrixXd a = stiffness_;
        a.diagonal() += (s * s + c * s) * mass_;
        const MatrixXd ff = follows_.transpose() * a * follows_, fs = follows_.transpose() * a * moves_;
        return moves_.transpose() * a * moves_ - fs.transpose() * ff.ldlt().solve(fs);
    }

    /// Of the elements on the tool at these nodes.
    [[nodiscard]] Vector3d force_n(const std::vector<std::uint32_t>& nodes) const {
        const VectorXd gradient = body_.gradient_n(positions_);
        Vector3d sum = Vector3d::Zero();
        for (const std::uint32_t node : nodes)
            sum -= gradient.segment<3>(3 * Eigen::Index{node});
        return sum;
    }
    [[nodiscard]] Vector3d position(std::uint32_t node) const {
        return positions_.segment<3>(3 * Eigen::Index{node});
    }

  private:
    static tools::ElasticBody make_body(const Asset& asset) {
        const MaterialObject object = object_of(asset);
        return {object.mesh, object.material};
    }

    const Asset& asset_;
    tools::ElasticBody body_;
    VectorXd positions_, mass_;
    MatrixXd stiffness_, moves_, follows_;
};

/// Entries are compared in proportion to what their directions feel on their own.
void expect_close(const Matrix6d& found, const Matrix6d& expected, double tolerance, int directions) {
    const double floor = kNothing * expected.diagonal().maxCoeff();
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            if (i >= directions || j >= directions) {
                EXPECT_EQ(found(i, j), 0);
                continue;
            }
            const double scale = std::sqrt(std::max(floor, expected(i, i)) * std::max(floor, expected(j, j)));
            EXPECT_NEAR(found(i, j), expected(i, j), tolerance * scale) << i << " " << j;
        }
    }
}

void expect_physical(const LocalModel& model) {
    for (const Mat6* m : {&model.stiffness, &model.damping, &model.mass}) {
        const Matrix6d a = to_eigen(*m);
        ASSERT_TRUE(a.allFinite());
        const double largest = std::max(1e-300, a.cwiseAbs().maxCoeff());
        EXPECT_LE((a - a.transpose()).cwiseAbs().maxCoeff(), kExact * largest);
        // Newtons and newton metres are different things: one unit of each weighs alike after scaling.
        Matrix6d scaled = a;
        for (int i = 0; i < 6; ++i) {
            const double s = a(i, i) > 0 ? 1 / std::sqrt(a(i, i)) : 0;
            scaled.row(i) *= s;
            scaled.col(i) *= s;
        }
        EXPECT_GE(Eigen::SelfAdjointEigenSolver<Matrix6d>(scaled).eigenvalues().minCoeff(), -kExact * 100);
    }
}

Asset heterogeneous(ToolShape shape, ToolContact contact, std::uint32_t n = 4) {
    Asset asset = cube_asset(n, shape, contact);
    make_heterogeneous(asset, 7);
    return asset;
}

TEST(LocalModel, Of_a_bonded_plate_is_the_condensed_stiffness_of_the_reference) {
    const Asset asset = heterogeneous(ToolShape::plate, ToolContact::bonded);
    const Vector3d move(4e-3, -2e-3, -8e-3), turn(0.05, -0.03, 0.1);
    for (const bool with_torque : {true, false}) {
        Simulation simulation = made(asset, views(with_torque));
        settle(simulation, asset, move, turn);
        const LocalModel model = view(simulation);
        Oracle oracle(asset, simulation);
        oracle.hold(asset.tools[0].nodes, {}, Vector3d(model.origin.position_m.data()));
        expect_close(to_eigen(model.stiffness), oracle.felt(0), kStiffnessTolerance, with_torque ? 6 : 3);
        expect_physical(model);
        EXPECT_FALSE(model.unilateral);
        EXPECT_EQ(model.touched_nodes, 25u);
        EXPECT_EQ(model.step, 120u);
        EXPECT_GT(model.radius_m, 0);
    }
}

TEST(LocalModel, In_float_is_as_good) {
    const Asset asset = heterogeneous(ToolShape::plate, ToolContact::bonded);
    Simulation simulation = made(asset, views(true, Arithmetic::float32));
    settle(simulation, asset, {4e-3, 0, -8e-3});
    const LocalModel model = view(simulation);
    Oracle oracle(asset, simulation);
    oracle.hold(asset.tools[0].nodes, {}, Vector3d(model.origin.position_m.data()));
    expect_close(to_eigen(model.stiffness), oracle.felt(0), kStiffnessTolerance, 6);
    expect_physical(model);
}

TEST(LocalModel, Of_a_frictionless_plate_resists_along_its_normal_only) {
    const Asset asset = heterogeneous(ToolShape::plate, ToolContact::frictionless);
    Simulation simulation = made(asset, views(true));
    settle(simulation, asset, {0, 0, -6e-3});
    const LocalModel model = view(simulation);
    Oracle oracle(asset, simulation);
    const std::vector<std::uint32_t>& nodes = asset.tools[0].nodes;
    oracle.hold(nodes, std::vector<Vector3d>(nodes.size(), Vector3d::UnitZ()),
                Vector3d(model.origin.position_m.data()));
    const Matrix6d expected = oracle.felt(0);
    expect_close(to_eigen(model.stiffness), expected, kStiffnessTolerance, 6);
    for (const int free : {0, 1, 5})
        EXPECT_LT(std::abs(to_eigen(model.stiffness)(free, free)), kFloatTolerance * expected(2, 2));
    expect_physical(model);
    EXPECT_TRUE(model.unilateral);
    EXPECT_NEAR(model.normal[2], 1, kExact);
}

/// Nodes on a ball, with their normals.
void find_touched(const Asset& asset, const Oracle& oracle, const Vector3d& centre,
                  std::vector<std::uint32_t>& nodes, std::vector<Vector3d>& normals) {
    for (const std::uint32_t node : asset.tools[0].nodes) {
        const Vector3d out = oracle.position(node) - centre;
        if (out.norm() > asset.tools[0].radius_m * (1 + 1e-4)) continue;
        nodes.push_back(node);
        normals.push_back(out.normalized());
    }
}

TEST(LocalModel, Of_a_ball_follows_the_nodes_that_it_touches) {
    for (const ToolContact contact : {ToolContact::frictionless, ToolContact::sticking}) {
        Asset asset = heterogeneous(ToolShape::sphere, contact, 6);
        asset.tools[0].radius_m = 0.05;
        asset.tools[0].rest_position_m[2] = 0.15;
        Simulation simulation = made(asset, views(true));
        settle(simulation, asset, {2e-3, 1e-3, -8e-3});
        const LocalModel model = view(simulation);
        Oracle oracle(asset, simulation);
        const Vector3d centre(model.origin.position_m.data());
        std::vector<std::uint32_t> nodes;
        std::vector<Vector3d> normals;
        find_touched(asset, oracle, centre, nodes, normals);
        ASSERT_EQ(nodes.size(), model.touched_nodes);
        ASSERT_GE(nodes.size(), 3u);
        if (contact == ToolContact::sticking) normals.clear();
        oracle.hold(nodes, normals, centre);
        expect_close(to_eigen(model.stiffness).topLeftCorner<6, 6>(), oracle.felt(0),
                     contact == ToolContact::sticking ? kStiffnessTolerance : 2 * kStiffnessTolerance, 6);
        expect_physical(model);
        EXPECT_GT(model.normal[2], 0.9);
        EXPECT_NEAR(Vector3d(model.normal.data()).norm(), 1, kExact);
    }
}

TEST(LocalModel, Mass_and_damping_have_value_and_slope_of_the_object_at_the_time_scale) {
    for (const double damping : {0.0, 40.0}) {
        Asset asset = heterogeneous(ToolShape::plate, ToolContact::bonded);
        asset.damping_per_s = damping;
        Simulation simulation = made(asset, views(true));
        settle(simulation, asset, {0, 0, -4e-3});
        const LocalModel model = view(simulation);
        Oracle oracle(asset, simulation);
        oracle.hold(asset.tools[0].nodes, {}, Vector3d(model.origin.position_m.data()));
        const double s = 1 / kFitted_s, step = 1e-3 * s;
        const Matrix6d felt = oracle.felt(s, damping);
        const Matrix6d slope = (oracle.felt(s + step, damping) - oracle.felt(s - step, damping)) / (2 * step);
        const Matrix6d m = to_eigen(model.mass), b = to_eigen(model.damping), k = to_eigen(model.stiffness);
        expect_close(s * s * m + s * b + k, felt, kStiffnessTolerance, 6);
        expect_close(2 * s * m + b, slope, kFitTolerance, 6);
        expect_physical(model);
    }
}

TEST(LocalModel, Force_is_what_the_elements_exert_whatever_the_tool_is_doing) {
    const Asset asset = heterogeneous(ToolShape::plate, ToolContact::bonded);
    Simulation simulation = made(asset, views(false));
    settle(simulation, asset, {0, 0, -4e-3});
    StepResult result;
    LocalModel model;
    for (int i = 1; i <= 5; ++i) {  // accelerates at 10 m/s^2
        const double t = i * 1e-3;
        result = simulation.step(pose_at(asset, {0, 0, -4e-3 - 5 * t * t}), 1e-3);
        ASSERT_TRUE(simulation.local_model(0, model));
    }
    const Oracle oracle(asset, simulation);
    const Vector3d expected = oracle.force_n(asset.tools[0].nodes);
    // The rotations of a step are those of its prediction.
    constexpr double kLinearised = 2e-3;
    EXPECT_LT((Vector3d(model.force_n.data()) - expected).norm(), kLinearised * expected.norm());
    EXPECT_GT((Vector3d(result.force_n.data()) - expected).norm(), 0.05 * expected.norm());
}

TEST(LocalModel, Force_of_a_moving_frictionless_plate_has_no_inertia_in_it) {
    const Asset asset = heterogeneous(ToolShape::plate, ToolContact::frictionless);
    Simulation simulation = made(asset, views(false));
    settle(simulation, asset, {0, 0, -4e-3});
    StepResult result;
    LocalModel model;
    for (int i = 1; i <= 5; ++i) {
        const double t = i * 1e-3;
        result = simulation.step(pose_at(asset, {0, 0, -4e-3 - 5 * t * t}), 1e-3);
        ASSERT_TRUE(simulation.local_model(0, model));
    }
    const Oracle oracle(asset, simulation);
    const double expected = oracle.force_n(asset.tools[0].nodes).z();
    EXPECT_NEAR(model.force_n[2], expected, 5e-3 * expected);
    EXPECT_GT(std::abs(result.force_n[2] - expected), 0.05 * expected);
}

TEST(LocalModel, With_a_coupling_tells_what_the_object_does_to_the_tool_where_the_tool_is) {
    const Asset asset = heterogeneous(ToolShape::plate, ToolContact::bonded);
    SimulationConfig config = views(false);
    config.coupling_stiffness_n_per_m = 1000;
    config.coupling_damping_n_s_per_m = 2;
    Simulation simulation = made(asset, config);
    settle(simulation, asset, {1e-3, 0, -8e-3}, Vector3d::Zero(), 400);
    const LocalModel model = view(simulation);
    Oracle oracle(asset, simulation);
    oracle.hold(asset.tools[0].nodes, {}, Vector3d(model.origin.position_m.data()));
    expect_close(to_eigen(model.stiffness), oracle.felt(0), kStiffnessTolerance, 3);
    const Vector3d expected = oracle.force_n(asset.tools[0].nodes);
    EXPECT_LT((Vector3d(model.force_n.data()) - expected).norm(), 1e-3 * expected.norm());
    EXPECT_EQ(model.origin.position_m, simulation.tool(0).tool_position_m);
    EXPECT_GT(model.origin.position_m[2], asset.tools[0].rest_position_m[2] - 7e-3);
}

TEST(LocalModel, Of_a_turned_scene_is_turned_with_it) {
    const Matrix3d turn = Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    const Asset asset = heterogeneous(ToolShape::sphere, ToolContact::frictionless, 5);
    Asset turned = asset;
    const auto rotate = [&](Point& p) {
        const Vector3d x = turn * Vector3d(p.data());
        p = {x.x(), x.y(), x.z()};
    };
    for (Point& p : turned.nodes_m)
        rotate(p);
    rotate(turned.tools[0].rest_position_m);
    const Eigen::Quaterniond q(turn);
    turned.tools[0].rest_orientation_wxyz = {q.w(), q.x(), q.y(), q.z()};
    Simulation a = made(asset, views(true)), b = made(turned, views(true));
    const Vector3d move(1e-3, 0, -6e-3);
    settle(a, asset, move);
    settle(b, turned, turn * move);
    const LocalModel in_a = view(a), in_b = view(b);
    Matrix6d both = Matrix6d::Zero();
    both.topLeftCorner<3, 3>() = both.bottomRightCorner<3, 3>() = turn;
    ASSERT_EQ(in_a.touched_nodes, in_b.touched_nodes);
    for (const auto member : {&LocalModel::stiffness, &LocalModel::damping, &LocalModel::mass}) {
        const Matrix6d expected = both * to_eigen(in_a.*member) * both.transpose();
        const Matrix6d found = to_eigen(in_b.*member);
        const double tolerance = member == &LocalModel::stiffness ? kStiffnessTolerance : kFitTolerance;
        for (const int at : {0, 3}) {
            const Matrix3d there = expected.block(at, at, 3, 3);
            EXPECT_LE((found.block(at, at, 3, 3) - there).norm(), tolerance * there.norm());
        }
    }
    EXPECT_LT((Vector3d(in_b.normal.data()) - turn * Vector3d(in_a.normal.data())).norm(), 1e-4);
    EXPECT_NEAR(in_b.radius_m, in_a.radius_m, 1e-6);
}

TEST(LocalModel, Of_a_free_floating_stiff_body_is_its_mass) {
    Asset asset = asset_of(kuhn_cube(3), [](const Point&) { return false; }, {1e8, 0.3, 1000});
    ToolSet tool;
    tool.name = "tool";
    tool.shape = ToolShape::plate;
    tool.contact = ToolContact::frictionless;
    tool.rest_position_m = {0.05, 0.05, 0.1};
    tool.nodes = free_nodes(asset, at_height(0.1));
    asset.tools = {tool};
    Simulation simulation = made(asset, views(true));
    for (int i = 1; i <= 5; ++i)
        simulation.step(pose_at(asset, {0, 0, -1e-3 * i * i}), 8e-3);
    const LocalModel model = view(simulation);
    ASSERT_GT(model.touched_nodes, 0u);
    expect_physical(model);
    EXPECT_NEAR(model.mass[14], 1, 0.02);               // kg: 0.1 m cubed of water
    EXPECT_LT(model.stiffness[14] * 1e-4, 0.02 * 1e2);  // against the mass at 10 ms
    EXPECT_LT(model.damping[14] / kFitted_s, 0.02 / (kFitted_s * kFitted_s));
}

TEST(LocalModel, After_the_touched_set_changed_is_that_of_the_new_set) {
    const Asset asset = heterogeneous(ToolShape::sphere, ToolContact::frictionless, 6);
    Simulation followed = made(asset, views(false)), fresh = made(asset, views(false));
    LocalModel model;
    for (int i = 1; i <= 120; ++i) {
        const Pose pose = pose_at(asset, std::min(1.0, i / 20.0) * Vector3d(2e-3, 1e-3, -8e-3));
        followed.step(pose, 8e-3);
        fresh.step(pose, 8e-3);
        ASSERT_TRUE(followed.local_model(0, model));
    }
    EXPECT_TRUE(model.converged);
    const LocalModel expected = view(fresh);
    expect_close(to_eigen(model.stiffness), to_eigen(expected.stiffness), kStiffnessTolerance, 3);
}

TEST(LocalModel, Away_from_the_object_is_empty_as_far_as_the_nearest_node) {
    const Asset asset = heterogeneous(ToolShape::sphere, ToolContact::frictionless, 4);
    Simulation simulation = made(asset, views(true));
    simulation.step(pose_at(asset, {0, 0, 2e-3}), 8e-3);
    const LocalModel model = view(simulation);
    EXPECT_EQ(model.touched_nodes, 0u);
    EXPECT_EQ(model.stiffness, Mat6{});
    EXPECT_EQ(model.mass, Mat6{});
    EXPECT_EQ(model.normal, Vec3{});
    EXPECT_TRUE(model.unilateral);
    EXPECT_NEAR(model.radius_m, 2e-3, 1e-6);
}

TEST(LocalModel, Changes_nothing_of_the_steps) {
    const Asset asset = heterogeneous(ToolShape::sphere, ToolContact::sticking, 5);
    SimulationConfig config = views(true, Arithmetic::float32);
    Simulation asked = made(asset, config);
    config.with_local_model = false;
    Simulation left_alone = made(asset, config);
    LocalModel model;
    for (int i = 1; i <= 200; ++i) {
        const Pose pose = pose_at(asset, {1e-3 * std::sin(0.1 * i), 0, -8e-3 * std::sin(0.03 * i)});
        const StepResult a = asked.step(pose, 4e-3), b = left_alone.step(pose, 4e-3);
        ASSERT_EQ(a.force_n, b.force_n) << i;
        ASSERT_EQ(a.torque_nm, b.torque_nm) << i;
        ASSERT_TRUE(asked.local_model(0, model));
    }
}

TEST(LocalModel, Is_refused_without_room_or_without_a_step) {
    const Asset asset = heterogeneous(ToolShape::plate, ToolContact::bonded, 2);
    LocalModel model;
    model.step = 77;
    SimulationConfig config;
    Simulation without = made(asset, config);
    without.step(pose_at(asset, {0, 0, -1e-3}), 1e-3);
    EXPECT_FALSE(without.local_model(0, model));
    config.with_local_model = true;
    Simulation with = made(asset, config);
    EXPECT_FALSE(with.local_model(0, model));
    with.step(pose_at(asset, {0, 0, -1e-3}), 1e-3);
    EXPECT_FALSE(with.local_model(1, model));
    with.step(pose_at(asset, {0, 0, -1e-3}), 1.0);
    EXPECT_FALSE(with.local_model(0, model));
    EXPECT_EQ(model.step, 77u);
    with.step(pose_at(asset, {0, 0, -1e-3}), 1e-3);
    EXPECT_TRUE(with.local_model(0, model));
    EXPECT_EQ(model.step, 2u);
    with.reset();
    EXPECT_FALSE(with.local_model(0, model));
}

TEST(LocalModel, Allocates_and_locks_nothing) {
    const Asset asset = heterogeneous(ToolShape::sphere, ToolContact::coulomb, 5);
    Simulation simulation = made(asset, views(true));
    LocalModel model;
    std::uint32_t most = 0;
    const WatchedCalls before = watched_calls();
    for (int i = 1; i <= 100; ++i) {
        simulation.step(pose_at(asset, {3e-3 * std::sin(0.1 * i), 0, -8e-3 * std::sin(0.03 * i)}), 4e-3);
        simulation.local_model(0, model);
        most = std::max(most, model.touched_nodes);
    }
    const WatchedCalls during = watched_calls() - before;
    EXPECT_EQ(during.allocations, 0);
    EXPECT_EQ(during.frees, 0);
    EXPECT_EQ(during.locks, 0);
    EXPECT_GT(most, 3u);
}

}  // namespace
}  // namespace knead::test
