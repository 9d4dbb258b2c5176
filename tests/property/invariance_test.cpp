// SPDX-License-Identifier: Apache-2.0
// The same object described in another way: turned, moved, mirrored, renumbered, in other units.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <numeric>

#include "property/moved_body.h"

namespace knead::test {
namespace {

// Both runs solve to 1e-9 of the force; over the dozen steps of a motion what is left adds up. Contrast 21.
constexpr double kForceTolerance = 1e-6;
constexpr double kTorqueTolerance = 1e-6;
constexpr double kPositionTolerance_m = 1e-8;  // 1e-7 of the object: where the force is right to 1e-6

std::uint64_t any_seed() {
    return static_cast<std::uint64_t>(*rc::gen::inRange(1, 1'000'000));
}

void expect_small(const Difference& found, double length_scale = 1) {
    RC_ASSERT(found.force < kForceTolerance);
    RC_ASSERT(found.torque < kTorqueTolerance);
    RC_ASSERT(found.position_m < length_scale * kPositionTolerance_m);
}

/// Every place of the asset and of its tools by `map`, every direction by `turn`.
template <class Map>
Asset placed(Asset asset, const Map& map, const Matrix3d& turn) {
    for (Point& node : asset.nodes_m)
        node = point_of(map(vector_of(node)));
    for (ToolSet& tool : asset.tools)
        tool.rest_position_m = point_of(map(vector_of(tool.rest_position_m)));
    asset.gravity_m_per_s2 = point_of(turn * vector_of(asset.gravity_m_per_s2));
    return asset;
}

RC_GTEST_PROP(Invariance, Turned_and_moved_body_gives_the_turned_force, ()) {
    const std::uint64_t seed = any_seed();
    Random random(seed + 1);
    const Matrix3d turn = random.rotation().toRotationMatrix();
    const Vector3d shift(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const auto map = [&](const Vector3d& x) -> Vector3d { return turn * x + shift; };
    const auto turned = [&](const Vector3d& v) -> Vector3d { return turn * v; };
    const Asset body = any_body(seed);
    Asset moved = placed(body, map, turn);
    const Eigen::Quaterniond q(turn);
    moved.tools[0].rest_orientation_wxyz = {q.w(), q.x(), q.y(), q.z()};
    ToolMotion motion;
    const Trace expected = run(body, motion);
    motion.slide_m = turn * motion.slide_m;
    motion.turn_rad = turn * motion.turn_rad;
    const Trace found = run(moved, motion);
    RC_ASSERT(found.status == kStepOk);
    expect_small(difference(found, expected, turned, turned, map));
}

RC_GTEST_PROP(Invariance, Mirrored_body_gives_the_mirrored_force, ()) {
    const Matrix3d mirror = Vector3d(-1, 1, 1).asDiagonal();
    const auto mirrored = [&](const Vector3d& v) -> Vector3d { return mirror * v; };
    const auto axial = [&](const Vector3d& v) -> Vector3d { return -(mirror * v); };  // turns and torques
    const Asset body = any_body(any_seed());
    Asset image = placed(body, mirrored, mirror);
    for (Tetrahedron& t : image.tetrahedra)
        std::swap(t[0], t[1]);
    ToolMotion motion;
    const Trace expected = run(body, motion);
    motion.slide_m = mirrored(motion.slide_m);
    motion.turn_rad = axial(motion.turn_rad);
    expect_small(difference(run(image, motion), expected, mirrored, axial, mirrored));
}

/// A permutation of [first, last) from the seed, as the new place of each.
void shuffle(std::vector<std::uint32_t>& place, std::size_t first, std::size_t last, Random& random) {
    for (std::size_t i = last - 1; i > first; --i) {
        const auto j =
            first + static_cast<std::size_t>(random.uniform(0, static_cast<double>(i - first + 1)));
        std::swap(place[i], place[std::min(j, i)]);
    }
}

RC_GTEST_PROP(Invariance, Renumbered_nodes_and_tetrahedra_give_the_same_force, ()) {
    const std::uint64_t seed = any_seed();
    Random random(seed + 2);
    const Asset body = any_body(seed);
    std::vector<std::uint32_t> node(body.nodes_m.size()), tetrahedron(body.tetrahedra.size());
    std::iota(node.begin(), node.end(), 0U);
    std::iota(tetrahedron.begin(), tetrahedron.end(), 0U);
    shuffle(node, 0, body.free_node_count, random);
    shuffle(node, body.free_node_count, node.size(), random);
    shuffle(tetrahedron, 0, tetrahedron.size(), random);
    Asset other = body;
    for (std::size_t n = 0; n < node.size(); ++n)
        other.nodes_m[node[n]] = body.nodes_m[n];
    for (std::size_t t = 0; t < tetrahedron.size(); ++t) {
        Tetrahedron corners = body.tetrahedra[t];
        for (std::uint32_t& corner : corners)
            corner = node[corner];
        const auto turns =
            static_cast<int>(random.uniform(0, 3));  // three of four corners in turn: still positive
        std::rotate(corners.begin(), corners.begin() + turns, corners.begin() + 3);
        other.tetrahedra[tetrahedron[t]] = corners;
        other.palette_index[tetrahedron[t]] = body.palette_index[t];
    }
    for (std::uint32_t& touched : other.tools[0].nodes)
        touched = node[touched];
    std::sort(other.tools[0].nodes.begin(), other.tools[0].nodes.end());
    const auto same = [](const Vector3d& v) { return v; };
    expect_small(difference(run(other), run(body), same, same, same, node));
}

/// Lengths by s and elasticities by a leave the times as they are when densities go by a / s^2.
RC_GTEST_PROP(Invariance, Other_units_of_length_and_force_give_the_same_numbers_in_them, ()) {
    const std::uint64_t seed = any_seed();
    Random random(seed + 3);
    const double s = std::pow(10, random.uniform(-2, 1.5));
    const double a = std::pow(10, random.uniform(-1, 4));
    const Asset body = any_body(seed);
    const auto longer = [&](const Vector3d& x) -> Vector3d { return s * x; };
    Asset other = placed(body, longer, s * Matrix3d::Identity());
    for (PaletteEntry& entry : other.palette) {
        entry.youngs_modulus_pa *= a;
        entry.density_kg_per_m3 *= a / (s * s);
    }
    ToolMotion motion;
    const Trace expected = run(body, motion);
    motion.slide_m *= s;
    const auto force = [&](const Vector3d& f) -> Vector3d { return a * s * s * f; };
    const auto torque = [&](const Vector3d& m) -> Vector3d { return a * s * s * s * m; };
    expect_small(difference(run(other, motion), expected, force, torque, longer), s);
}

Asset stiffer_and_heavier(Asset asset, double factor) {
    for (PaletteEntry& entry : asset.palette) {
        entry.youngs_modulus_pa *= factor;
        entry.density_kg_per_m3 *= factor;
    }
    return asset;
}

RC_GTEST_PROP(Invariance, Twice_the_elasticity_and_density_give_twice_the_force_in_the_same_motion, ()) {
    const Asset body = any_body(any_seed());
    const auto twice = [](const Vector3d& v) -> Vector3d { return 2 * v; };
    const auto same = [](const Vector3d& v) { return v; };
    expect_small(difference(run(stiffer_and_heavier(body, 2)), run(body), twice, twice, same));
}

/// A factor of 4 changes no digit of any number, nor of a square root: to the bit, in float too.
RC_GTEST_PROP(Invariance, Four_times_the_elasticity_and_density_give_four_times_the_force_to_the_bit, ()) {
    const Asset body = any_body(any_seed());
    const Asset stiffer = stiffer_and_heavier(body, 4);
    const ToolMotion motion;
    for (const Arithmetic arithmetic : {Arithmetic::float32, Arithmetic::float64}) {
        SimulationConfig config;
        config.arithmetic = arithmetic;
        config.expected_dt_s = motion.dt_s;
        const Trace once = run(body, motion, config);
        const Trace four = run(stiffer, motion, config);
        for (std::size_t k = 0; k < once.forces_n.size(); ++k)
            RC_ASSERT(Vector3d(4 * once.forces_n[k]) == four.forces_n[k]);
        for (std::size_t n = 0; n < once.positions_m.size(); ++n)
            RC_ASSERT(once.positions_m[n] == four.positions_m[n]);
    }
}

}  // namespace
}  // namespace knead::test
