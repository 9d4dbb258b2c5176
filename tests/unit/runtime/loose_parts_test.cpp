// SPDX-License-Identifier: Apache-2.0
#include "core/loose_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "unit/runtime/press.h"

namespace knead::test {
namespace {

using core::Field;
using core::Vec;

constexpr double kSide_m = 0.02;

/// Blocks beside each other along x that share no node, `kBetween_m` apart.
constexpr double kBetween_m = 0.1;
TetMesh row_of_blocks(int count) {
    TetMesh row;
    for (int b = 0; b < count; ++b) {
        const TetMesh block = kuhn_box(2, 1, 1, {2 * kSide_m, kSide_m, kSide_m});
        const auto first = static_cast<std::uint32_t>(row.nodes_m.size());
        for (const Point& p : block.nodes_m)
            row.nodes_m.push_back({p[0] + b * kBetween_m, p[1], p[2]});
        for (Tetrahedron t : block.tetrahedra) {
            for (std::uint32_t& node : t)
                node += first;
            row.tetrahedra.push_back(t);
        }
    }
    return row;
}
template <class P>
int block_of(const P& p) {
    return static_cast<int>(p[0] / kBetween_m);
}

ToolSet tool_on(const Asset& asset, ToolContact contact, const NodeTest& touches) {
    ToolSet tool;
    tool.name = "tool";
    tool.contact = contact;
    tool.rest_position_m = {0, 0, kSide_m + 0.001};
    tool.nodes = free_nodes(asset, touches);
    return tool;
}

TEST(LooseParts, are_those_without_a_node_that_is_fixed_or_bonded) {
    Asset asset =
        asset_of(row_of_blocks(4), [](const Point& p) { return block_of(p) == 1 && p[2] < kSide_m / 2; });
    asset.tools = {tool_on(asset, ToolContact::bonded,
                           [](const Point& p) { return block_of(p) == 2 && p[2] > kSide_m / 2; })};
    const core::Model model = core::build_model(asset, {0});
    ASSERT_EQ(model.loose_parts.size(), 2u);
    const double block_kg = 2 * std::pow(kSide_m, 3) * kGel.density_kg_per_m3;
    int expected = 0;
    for (const core::LoosePart& part : model.loose_parts) {
        EXPECT_EQ(part.nodes.size(), 12u);
        EXPECT_NEAR(part.mass_kg, block_kg, 1e-12);
        for (const std::uint32_t node : part.nodes)
            EXPECT_EQ(block_of(model.rest_m[node]), expected);
        expected = 3;
    }
    EXPECT_TRUE(
        core::build_model(cube_asset(2, ToolShape::plate, ToolContact::bonded), {0}).loose_parts.empty());
}

/// Of two stiff blocks one is hit at its end and flies off, spinning; the other lies where it is, held by
/// nothing or by its bottom.
TEST(LooseParts, keep_momentum_and_spin_each_for_itself) {
    const auto block = [](int b) { return [b](const Vec& rest_m) { return block_of(rest_m) == b; }; };
    for (const bool other_is_held : {false, true}) {
        Asset asset = asset_of(row_of_blocks(2), [&](const Point& p) {
            return other_is_held && block_of(p) == 1 && p[2] < kSide_m / 2;
        });
        asset.palette[0].youngs_modulus_pa = 1e9;
        asset.tools = {tool_on(asset, ToolContact::frictionless, [](const Point& p) {
            return block_of(p) == 0 && p[0] < kSide_m / 2 && p[2] > kSide_m / 2;
        })};
        Stepper stepper(asset, {});
        for (int i = 0; i < 50; ++i)
            (void)stepper.step(moved(asset, {0, 0, -0.0001 * i}), 1e-3);
        (void)stepper.step(moved(asset, {0, 0, 1}), 1e-3);
        const Flight hit = flight_of(stepper, block(0));
        ASSERT_GT(hit.spin.norm(), 1e-6);
        Vec expected = hit.spin;
        for (int i = 0; i < 500; ++i) {
            const Field v0 = stepper.velocities_m_per_s();
            (void)stepper.step(moved(asset, {0, 0, 1}), 1e-3);
            expected += spin_of_implicit_euler(stepper, v0, 1e-3);
        }
        const Flight now = flight_of(stepper, block(0)), other = flight_of(stepper, block(1));
        EXPECT_LT((now.momentum - hit.momentum).norm(), 1e-4 * hit.momentum.norm());
        EXPECT_LT((now.spin - expected).norm(), 1e-3 * hit.spin.norm());
        EXPECT_LT(other.momentum.norm(), 1e-9 * hit.momentum.norm());
        EXPECT_LT(other.spin.norm(), 1e-9 * hit.spin.norm());
    }
}

}  // namespace
}  // namespace knead::test
