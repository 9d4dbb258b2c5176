// SPDX-License-Identifier: Apache-2.0
// Contact on a body that is solved densely and exactly: what the active set does, without the solver.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <random>

#include "knead/formats/tool_names.h"
#include "unit/runtime/dense_body.h"

namespace knead::test {
namespace {

using core::Contact;
using core::Mat;
using Eigen::AngleAxisd;

/// A node this deep in a tool is rounding: core's own gap tolerance for a cube of 0.1 m.
constexpr double kGap_m = 2e-9;
/// A frictionless node moves in the tangent plane of where it was predicted, so it leaves a curved surface by
/// slip^2 / (2 radius): below this at the speeds of these tests.
constexpr double kCurvatureGap_m = 1e-5;
constexpr double kTolerance = 1e-9;  ///< relative, of the dense solves
constexpr std::uint32_t kCells = 3;

Asset touched_cube(ToolShape shape, ToolContact contact, double friction = 0.4) {
    Asset asset = cube_asset(kCells, shape, contact);
    ToolSet& tool = asset.tools[0];
    if (contact == ToolContact::coulomb) tool.friction_coefficient = friction;
    if (shape != ToolShape::plate) tool.radius_m = 0.03;
    if (shape != ToolShape::plate) tool.rest_position_m = {0.045, 0.04, 0.13};
    return asset;
}

/// How deep a place is in a tool, and the outward normal there, in the scene. Not the core's geometry.
double depth_in(const ToolSet& tool, const Frame& frame, const Vec& place, Vec& outward) {
    const Vec axis = frame.rotation * Vec::UnitZ();
    if (tool.shape == ToolShape::plate) {
        outward = -axis;
        return (place - frame.position).dot(axis);
    }
    Vec away = place - frame.position;
    if (tool.shape == ToolShape::capsule) {
        const double along = away.dot(axis);
        away -= std::max(-tool.half_length_m, std::min(tool.half_length_m, along)) * axis;
    }
    outward = away.normalized();
    return tool.radius_m - away.norm();
}

std::vector<bool> held_nodes(const DenseBody& body) {
    std::vector<bool> held(body.model.rest_m.size(), false);
    for (const auto& constraint : body.constraints)
        held[constraint.node] = true;
    return held;
}

/// At the end of a step: nothing in a tool, nothing pulled, what pushes is on the surface.
void expect_unilateral(const Asset& asset, const DenseBody& body, const std::vector<Frame>& frames) {
    const std::vector<bool> held = held_nodes(body);
    Vec outward;
    for (std::size_t t = 0; t < asset.tools.size(); ++t) {
        for (const auto node : asset.tools[t].nodes) {
            if (held[node]) continue;
            EXPECT_LT(depth_in(asset.tools[t], frames[t], body.positions[node], outward), kGap_m);
        }
    }
    for (std::size_t k = 0; k < body.constraints.size(); ++k) {
        const auto& c = body.constraints[k];
        const double depth = depth_in(asset.tools[c.tool], frames[c.tool], body.positions[c.node], outward);
        EXPECT_LT(depth, kGap_m) << "node " << c.node;
        EXPECT_GT(depth, -kCurvatureGap_m) << "node " << c.node;
        const double pull = outward.dot(core::force_on_tool(c, body.rows_n[k]));
        EXPECT_LE(pull, 10 * body.pull_tolerance_n + 1e-12) << "node " << c.node;
    }
}

/// Comes, presses, slides, turns, leaves, and leaves for good; 1 s.
Frame on_the_way(const Frame& rest, double time_s) {
    const double press = std::min(1.0, time_s / 0.3);
    const double slide = std::clamp((time_s - 0.3) / 0.2, 0.0, 1.0);
    const double turn = std::clamp((time_s - 0.5) / 0.2, 0.0, 1.0);
    const double leave = std::max(0.0, time_s - 0.7);
    const double z = 0.002 - 0.012 * (1 - std::cos(EIGEN_PI * press)) / 2 + leave * leave / 2;
    return placed(rest, Vec(0.01 * slide, 0.004 * slide, z),
                  AngleAxisd(0.3 * turn, Vec(0.1, 0, 1).normalized()));
}

class Touching : public testing::TestWithParam<std::tuple<ToolShape, ToolContact>> {};

TEST_P(Touching, holds_only_what_pushes_and_lets_nothing_in_in_every_step) {
    const auto [shape, contact] = GetParam();
    const Asset asset = touched_cube(shape, contact);
    DenseBody body(asset, 2e-3);
    std::uint32_t most = 0;
    double push = 0, pull = 0;
    for (int i = 1; i <= 500 && !HasFailure(); ++i) {
        const Frame frame = on_the_way(body.rest_frames[0], i * body.dt);
        ASSERT_EQ(body.step({frame}, kTolerance).revision, Contact::Revision::settled) << "step " << i;
        expect_unilateral(asset, body, {frame});
        const auto& load = body.contact.load(0);
        most = std::max(most, load.touched);
        push = std::max(push, load.force_n.z());
        if (i * body.dt > 0.7) pull = std::max(pull, -load.force_n.z());
    }
    EXPECT_GT(most, 0u);
    EXPECT_GT(push, 1);
    EXPECT_LE(pull, 1e-9);
    EXPECT_EQ(body.contact.load(0).touched, 0u);
    EXPECT_EQ(body.contact.load(0).force_n, Vec(Vec::Zero()));
    EXPECT_EQ(body.contact.load(0).torque_n_m, Vec(Vec::Zero()));
}

TEST_P(Touching, slowly_does_not_let_a_node_go_and_catch_it_again) {
    const auto [shape, contact] = GetParam();
    for (const double dt : {1e-3, 10e-3}) {
        const Asset asset = touched_cube(shape, contact);
        DenseBody body(asset, dt);
        std::vector<bool> before(body.model.rest_m.size(), false);
        std::vector<int> caught(body.model.rest_m.size(), 0);
        const double seconds = 1;
        for (int i = 1; i * dt <= seconds; ++i) {
            const double z = 0.002 - 0.012 * i * dt / seconds;  // 12 mm/s
            (void)body.step({placed(body.rest_frames[0], Vec(0, 0, z))}, 1e-4);
            const std::vector<bool> held = held_nodes(body);
            for (std::size_t n = 0; n < held.size(); ++n)
                caught[n] += held[n] && !before[n] ? 1 : 0;
            before = held;
        }
        EXPECT_LE(*std::max_element(caught.begin(), caught.end()), 1) << "dt " << dt;
        EXPECT_GE(*std::max_element(caught.begin(), caught.end()), 1) << "dt " << dt;
    }
}

TEST_P(Touching, is_the_same_to_the_bit_whether_far_nodes_are_looked_at_or_not) {
    const auto [shape, contact] = GetParam();
    const Asset asset = touched_cube(shape, contact);
    DenseBody skipping(asset, 2e-3), looking(asset, 2e-3);
    looking.travel_factor = 1e9;
    for (int i = 1; i <= 500; ++i) {
        const Frame frame = on_the_way(skipping.rest_frames[0], i * skipping.dt);
        (void)skipping.step({frame}, kTolerance);
        (void)looking.step({frame}, kTolerance);
        ASSERT_EQ(skipping.positions, looking.positions) << "step " << i;
    }
}

std::string name_of(const testing::TestParamInfo<std::tuple<ToolShape, ToolContact>>& tested) {
    return std::string(name_of(std::get<0>(tested.param))) + "_" + name_of(std::get<1>(tested.param));
}

INSTANTIATE_TEST_SUITE_P(
    Tools, Touching,
    testing::Combine(testing::Values(ToolShape::plate, ToolShape::sphere, ToolShape::capsule),
                     testing::Values(ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb)),
    name_of);

/// The forces of a frictionless plate by projected Gauss-Seidel on the linear complementarity problem of the
/// step: W f + g >= 0, f >= 0, f (W f + g) = 0, with g the gaps that would be without the plate.
Eigen::VectorXd oracle_push(const DenseBody& body, const ToolSet& tool, const Frame& frame) {
    const auto count = static_cast<Eigen::Index>(tool.nodes.size());
    const Eigen::VectorXd motion = body.free_motion();
    const Vec outward = -frame.rotation.col(2);
    Eigen::MatrixXd w(count, count);
    Eigen::VectorXd gap(count), push = Eigen::VectorXd::Zero(count);
    for (Eigen::Index a = 0; a < count; ++a) {
        const auto i = tool.nodes[static_cast<std::size_t>(a)];
        gap[a] = outward.dot(body.positions[i] + motion.segment<3>(3 * i) - frame.position);
        for (Eigen::Index b = 0; b < count; ++b) {
            const auto j = tool.nodes[static_cast<std::size_t>(b)];
            w(a, b) = outward.dot(body.mobility().block<3, 3>(3 * i, 3 * j) * outward);
        }
    }
    for (int sweep = 0; sweep < 100000; ++sweep) {
        double change = 0;
        for (Eigen::Index a = 0; a < count; ++a) {
            const double next = std::max(0.0, push[a] - (gap[a] + w.row(a).dot(push)) / w(a, a));
            change = std::max(change, std::abs(next - push[a]));
            push[a] = next;
        }
        if (change < 1e-13) break;
    }
    return push;
}

/// Blows of a rough plate on a body that is shown to the contact when its solves are wrong by `glance_error`.
/// @return how often that changed the set
int expect_forces_of_the_complementarity_problem(double glance_error) {
    Asset asset = touched_cube(ToolShape::plate, ToolContact::frictionless);
    make_heterogeneous(asset, 4);
    std::mt19937_64 engine(7);
    const auto uniform = [&engine] { return 2 * static_cast<double>(engine() >> 11U) * 0x1.0p-53 - 1; };
    DenseBody body(asset, 2e-3);
    body.glance_error = glance_error;
    int touching = 0, changes = 0;
    std::size_t before = 0;
    for (int i = 0; i < 200; ++i) {
        // Rough: blows from above with a tilted plate.
        const Frame frame = placed(body.rest_frames[0], Vec(0, 0, 0.004 * uniform()),
                                   AngleAxisd(0.05 * uniform(), Vec(uniform(), uniform(), 0.1).normalized()));
        const Eigen::VectorXd push = oracle_push(body, asset.tools[0], frame);
        EXPECT_EQ(body.step({frame}, 1e-12).revision, Contact::Revision::settled) << "step " << i;
        Eigen::VectorXd found = Eigen::VectorXd::Zero(push.size());
        for (std::size_t k = 0; k < body.constraints.size(); ++k) {
            const auto& nodes = asset.tools[0].nodes;
            const auto at = std::lower_bound(nodes.begin(), nodes.end(), body.constraints[k].node);
            found[at - nodes.begin()] = frame.rotation.col(2).dot(body.constraints[k].held * body.rows_n[k]);
        }
        EXPECT_LT((found - push).norm(), 1e-6 * (1 + push.norm())) << "step " << i;
        touching += push.sum() > 0 ? 1 : 0;
        changes += body.constraints.size() != before ? 1 : 0;
        before = body.constraints.size();
    }
    EXPECT_GT(touching, 50);
    EXPECT_GT(changes, 50);
    return body.glances;
}

TEST(ActiveSet, of_a_frictionless_plate_finds_the_forces_of_the_complementarity_problem) {
    expect_forces_of_the_complementarity_problem(0);
}

TEST(ActiveSet, that_looked_at_solves_on_their_way_finds_the_same_forces) {
    for (const double error : {1e-3, 0.1, 1.0})
        EXPECT_GT(expect_forces_of_the_complementarity_problem(error), 50) << "error " << error;
}

TEST_P(Touching, is_as_right_after_looks_at_solves_on_their_way) {
    const auto [shape, contact] = GetParam();
    const Asset asset = touched_cube(shape, contact);
    DenseBody body(asset, 2e-3);
    body.glance_error = 0.1;
    for (int i = 1; i <= 500 && !HasFailure(); ++i) {
        const Frame frame = on_the_way(body.rest_frames[0], i * body.dt);
        ASSERT_EQ(body.step({frame}, kTolerance).revision, Contact::Revision::settled) << "step " << i;
        expect_unilateral(asset, body, {frame});
    }
    // Only frictionless tools catch nodes that early; the others may merely let go.
    if (contact == ToolContact::frictionless) {
        EXPECT_GT(body.glances, 2);
    }
    EXPECT_EQ(body.contact.load(0).touched, 0u);
}

RC_GTEST_PROP(ActiveSet, ends_its_passes_whatever_the_tools_do, ()) {
    const auto share = [] { return *rc::gen::inRange(-1000, 1001) / 1e3; };
    static const Asset asset = [] {
        Asset made = touched_cube(ToolShape::plate, ToolContact::coulomb, 1.5);
        make_heterogeneous(made, 9);
        made.tools.push_back(touched_cube(ToolShape::capsule, ToolContact::coulomb, 0.2).tools[0]);
        made.tools.push_back(touched_cube(ToolShape::sphere, ToolContact::sticking).tools[0]);
        return made;
    }();
    static DenseBody body(asset, 2e-3);
    body.glance_error = *rc::gen::element(0.0, 1e-3, 0.1, 1.0);
    body.contact.reset();
    body.positions = body.model.rest_m;
    std::fill(body.velocities.begin(), body.velocities.end(), Vec::Zero());
    for (int i = 0; i < 10; ++i) {
        std::vector<Frame> frames;
        for (const Frame& rest : body.rest_frames) {
            frames.push_back(placed(rest, 0.02 * Vec(share(), share(), share()),
                                    AngleAxisd(share(), Vec(share(), share(), 1.5).normalized())));
        }
        RC_ASSERT(body.step(frames, 1e-4, 500).revision != Contact::Revision::changed);
    }
}

TEST(ActiveSet, that_is_run_again_gives_the_same_bits) {
    Asset asset = touched_cube(ToolShape::capsule, ToolContact::coulomb);
    DenseBody first(asset, 2e-3), second(asset, 2e-3);
    const auto run = [](DenseBody& body, int steps) {
        for (int i = 1; i <= steps; ++i)
            (void)body.step({on_the_way(body.rest_frames[0], i * body.dt)}, 1e-4);
    };
    run(second, 200);
    second.contact.reset();
    second.positions = second.model.rest_m;
    std::fill(second.velocities.begin(), second.velocities.end(), Vec::Zero());
    run(first, 300);
    run(second, 300);
    EXPECT_GT(first.contact.load(0).touched, 0u);
    EXPECT_EQ(first.positions, second.positions);
    EXPECT_EQ(first.contact.load(0).force_n, second.contact.load(0).force_n);
}

TEST(ActiveSet, abandoned_in_a_step_is_as_before_it) {
    Asset asset = touched_cube(ToolShape::plate, ToolContact::coulomb);
    asset.tools.push_back(touched_cube(ToolShape::sphere, ToolContact::sticking).tools[0]);
    DenseBody body(asset, 2e-3), same(asset, 2e-3);
    const auto frames = [&](int i) {
        return std::vector<Frame>{placed(body.rest_frames[0], Vec(1e-4 * i, 0, 0.03 - 4e-4 * i)),
                                  placed(body.rest_frames[1], Vec(0, 0, 2e-4 * i - 0.004))};
    };
    for (int i = 1; i <= 100; ++i) {
        DenseBody& restless = body;
        if (i % 7 == 0) restless.try_and_abandon({frames(i + 30)[0], frames(i - 50)[1]});
        (void)body.step(frames(i), 1e-6);
        (void)same.step(frames(i), 1e-6);
        ASSERT_LT((body.positions.front() - same.positions.front()).norm(), 1e-9) << "step " << i;
        ASSERT_EQ(held_nodes(body), held_nodes(same)) << "step " << i;
    }
    EXPECT_GT(body.contact.load(0).touched, 0u);
}

/// A cube between two plates that push from -x and +x.
Asset pinched_cube(ToolContact contact) {
    Asset asset = asset_of(kuhn_cube(kCells), [](const Point&) { return false; });
    for (const double side : {-1.0, 1.0}) {
        ToolSet tool;
        tool.name = side < 0 ? "left" : "right";
        tool.contact = contact;
        tool.friction_coefficient = contact == ToolContact::coulomb ? 0.5 : 0;
        tool.rest_position_m = {side < 0 ? 0.0 : 0.1, 0.05, 0.05};
        tool.rest_orientation_wxyz = {std::sqrt(0.5), 0, side * std::sqrt(0.5), 0};  // z outwards
        for (std::uint32_t i = 0; i < asset.free_node_count; ++i) {
            if (std::abs(asset.nodes_m[i][0] - tool.rest_position_m[0]) < 0.04) tool.nodes.push_back(i);
        }
        asset.tools.push_back(tool);
    }
    return asset;
}

TEST(TwoTools, that_pinch_a_body_feel_equal_and_opposite_forces) {
    for (const auto contact : {ToolContact::sticking, ToolContact::frictionless, ToolContact::coulomb}) {
        const Asset asset = pinched_cube(contact);
        DenseBody body(asset, 10e-3);
        for (int i = 1; i <= 200; ++i) {
            const double in = 0.005 * std::min(1.0, i / 100.0);
            ASSERT_EQ(body.step({placed(body.rest_frames[0], Vec(in, 0, 0)),
                                 placed(body.rest_frames[1], Vec(-in, 0, 0))},
                                1e-6)
                          .revision,
                      Contact::Revision::settled);
        }
        const auto &left = body.contact.load(0), &right = body.contact.load(1);
        EXPECT_LT(left.force_n.x(), -10);
        EXPECT_LT((left.force_n + right.force_n).norm(), 1e-4 * left.force_n.norm());
        EXPECT_EQ(left.touched, 16u);
        EXPECT_EQ(right.touched, 16u);
    }
}

TEST(TwoTools, in_one_place_share_no_node_and_the_first_listed_has_it_until_it_lets_go) {
    Asset asset = touched_cube(ToolShape::plate, ToolContact::sticking);
    asset.tools.push_back(asset.tools[0]);
    asset.tools[1].name = "second";
    DenseBody body(asset, 2e-3);
    const auto frames = [&](double first, double second) {
        return std::vector<Frame>{placed(body.rest_frames[0], Vec(0, 0, first)),
                                  placed(body.rest_frames[1], Vec(0, 0, second))};
    };
    (void)body.step(frames(-0.001, -0.001));
    EXPECT_EQ(body.contact.load(0).touched, 16u);
    EXPECT_EQ(body.contact.load(1).touched, 0u);
    for (int i = 0; i < 50; ++i)
        (void)body.step(frames(-0.001, -0.0005));
    EXPECT_EQ(body.contact.load(0).touched, 16u);
    for (int i = 0; i < 50; ++i)
        (void)body.step(frames(0.02, -0.0005));
    EXPECT_EQ(body.contact.load(0).touched, 0u);
    EXPECT_EQ(body.contact.load(1).touched, 16u);
    // Now the second had it first.
    for (int i = 0; i < 50; ++i)
        (void)body.step(frames(-0.0005, -0.0005));
    EXPECT_EQ(body.contact.load(1).touched, 16u);
}

TEST(BondedTool, keeps_its_nodes_from_others_and_may_be_left_out_of_the_list) {
    Asset asset = touched_cube(ToolShape::plate, ToolContact::frictionless);
    ToolSet grip = asset.tools[0];
    grip.name = "grip";
    grip.contact = ToolContact::bonded;
    grip.nodes = {asset.tools[0].nodes[2], asset.tools[0].nodes[9]};
    asset.tools.push_back(grip);
    DenseBody listed(asset, 2e-3);
    const auto frames = [&](double depth) {
        return std::vector<Frame>{placed(listed.rest_frames[0], Vec(0, 0, depth)), listed.rest_frames[1]};
    };
    (void)listed.step(frames(-0.001));
    EXPECT_EQ(listed.contact.load(0).touched, 14u);
    EXPECT_EQ(listed.contact.load(1).touched, 2u);
    EXPECT_EQ(listed.constraints.front().tool, 1u);
    ASSERT_EQ(listed.contact.bonds(1).size(), 2u);
    for (const core::Bond& bond : listed.contact.bonds(1)) {
        EXPECT_LT((listed.positions[bond.node] - listed.rest_frames[1].to_scene(bond.anchor)).norm(), 1e-14);
    }
    DenseBody left_out(asset, 2e-3, core::BondedNodes::left_out);
    (void)left_out.step(frames(-0.001));
    EXPECT_EQ(left_out.constraints.size(), 14u);
    EXPECT_EQ(left_out.contact.bonds(1).size(), 2u);
}

TEST(BoundedPlate, catches_no_node_that_it_passed_beside_until_that_has_been_in_front_again) {
    Asset asset = touched_cube(ToolShape::plate, ToolContact::frictionless);
    asset.tools[0].half_extents_m = {0.02, 0.06};  // the two inner rows of four: x = 1/30 and 2/30
    DenseBody body(asset, 2e-3);
    const auto go = [&](double x, double z, int steps) {
        for (int i = 0; i < steps; ++i)
            (void)body.step({placed(body.rest_frames[0], Vec(x, 0, z))});
        return body.contact.load(0).touched;
    };
    EXPECT_EQ(go(0, -0.004, 100), 8u);
    // Over the rows that stand beside it, above its face: it keeps and loses rows, but snatches none.
    for (int i = 1; i <= 75; ++i)
        EXPECT_LE(go(4e-4 * i, -0.004, 1), 8u);
    EXPECT_EQ(body.contact.load(0).touched, 4u);
    EXPECT_EQ(go(0.045, -0.004, 50), 0u);
    // Up and down again, there: now it touches the row at x = 0.1, which has been in front of it.
    EXPECT_EQ(go(0.045, 0.01, 100), 0u);
    EXPECT_EQ(go(0.045, -0.004, 100), 4u);
}

}  // namespace
}  // namespace knead::test
