// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/press_contrast.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <random>
#include <set>

#include "knead/formats/numerics.h"
#include "unit/runtime/block_asset.h"

namespace knead::test {
namespace {

constexpr double kSoft_pa = 1e3;
constexpr double kMedium_pa = 1e5;
constexpr double kStiff_pa = 1e9;
constexpr std::uint32_t kCells = 5;       ///< along an edge of the cube
constexpr double kCell_m = 0.1 / kCells;  ///< the cube's side is 0.1 m

Point centroid(const Asset& asset, const Tetrahedron& t) {
    Point middle{};
    for (const std::uint32_t node : t)
        for (std::size_t axis = 0; axis < 3; ++axis)
            middle[axis] += asset.nodes_m[node][axis] / 4;
    return middle;
}

/// The cell of the cube that a tetrahedron is in: 0 ... kCells - 1 along x, y, z.
using Cell = std::array<int, 3>;

/// The cube on its table with the tool on top; every cell as stiff as `modulus_pa` says.
Asset cube(ToolContact contact, const std::function<double(const Cell&)>& modulus_pa) {
    Asset asset = cube_asset(kCells, ToolShape::plate, contact);
    asset.palette.clear();
    for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
        const Point middle = centroid(asset, asset.tetrahedra[t]);
        Cell cell{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            cell[axis] = static_cast<int>(middle[axis] / kCell_m);
        asset.palette_index[t] = static_cast<std::uint32_t>(asset.palette.size());
        asset.palette.push_back({modulus_pa(cell), 0.3, 1000});
    }
    return asset;
}

double island(const Cell& cell) {
    const auto inside = [](int i) { return i >= 1 && i < static_cast<int>(kCells) - 1; };
    return inside(cell[0]) && inside(cell[1]) && inside(cell[2]) ? kStiff_pa : kSoft_pa;
}
double column(const Cell& cell) {
    return cell[0] == 0 && cell[1] == 0 ? kStiff_pa : kSoft_pa;
}
double column_under_a_lid(const Cell& cell) {
    return cell[2] == static_cast<int>(kCells) - 1 ? kStiff_pa : column(cell);
}
double column_with_a_medium_joint(const Cell& cell) {
    return cell[2] == 2 && column(cell) == kStiff_pa ? kMedium_pa : column_under_a_lid(cell);
}
double soft_layer_below(const Cell& cell) {
    return cell[2] == 0 ? kSoft_pa : kStiff_pa;
}

struct Case {
    const char* what;
    double (*modulus_pa)(const Cell&);
    ToolContact contact;
    double path_pa;
};

constexpr Case kCases[] = {
    {"island", island, ToolContact::bonded, kSoft_pa},
    {"column", column, ToolContact::bonded, kStiff_pa},            // any node of a bonded tool will do
    {"column", column, ToolContact::frictionless, kSoft_pa},       // the tool may come down beside it
    {"lid", column_under_a_lid, ToolContact::coulomb, kStiff_pa},  // from wherever it touches
    {"joint", column_with_a_medium_joint, ToolContact::bonded, kMedium_pa},
    {"joint", column_with_a_medium_joint, ToolContact::sticking, kMedium_pa},
    {"series", soft_layer_below, ToolContact::bonded, kSoft_pa},
    {"series", soft_layer_below, ToolContact::sticking, kSoft_pa},
};

TEST(Path_of_the_force, Is_as_soft_as_the_softest_that_it_cannot_avoid) {
    for (const Case& c : kCases) {
        const Asset asset = cube(c.contact, c.modulus_pa);
        EXPECT_EQ(path_youngs_modulus_pa(asset), c.path_pa) << c.what << static_cast<int>(c.contact);
        const Numerics numerics = choose_numerics(asset);
        EXPECT_EQ(numerics.press_contrast, kStiff_pa / c.path_pa) << c.what;
        EXPECT_EQ(numerics.contrast, kStiff_pa / kSoft_pa) << c.what;
    }
}

TEST(Path_of_the_force, Of_several_tools_is_that_of_the_worst) {
    Asset asset = cube(ToolContact::bonded, column);
    ToolSet second = asset.tools[0];
    second.name = "second";
    second.nodes = free_nodes(asset, [](const Point& p) { return p[0] > 0.1 - kOnPlane_m; });
    asset.tools.push_back(second);
    EXPECT_EQ(path_youngs_modulus_pa(asset), kSoft_pa);
    asset.tools.pop_back();
    EXPECT_EQ(path_youngs_modulus_pa(asset), kStiff_pa);
}

TEST(Path_of_the_force, Does_not_look_at_a_tool_that_touches_no_node) {
    Asset asset = cube(ToolContact::bonded, column);
    asset.tools.push_back(asset.tools[0]);
    asset.tools.back().contact = ToolContact::frictionless;
    asset.tools.back().nodes.clear();
    EXPECT_EQ(path_youngs_modulus_pa(asset), kStiff_pa);
}

TEST(Path_of_the_force, Is_the_softest_of_all_where_there_is_none) {
    Asset nothing_held = cube(ToolContact::bonded, column);
    nothing_held.free_node_count = static_cast<std::uint32_t>(nothing_held.nodes_m.size());
    EXPECT_EQ(path_youngs_modulus_pa(nothing_held), kSoft_pa);

    Asset no_tool = cube(ToolContact::bonded, column);
    no_tool.tools[0].nodes.clear();
    EXPECT_EQ(path_youngs_modulus_pa(no_tool), kSoft_pa);

    Asset in_two_parts = cube(ToolContact::bonded, soft_layer_below);  // the layer taken out
    for (std::size_t t = in_two_parts.tetrahedra.size(); t-- > 0;) {
        if (centroid(in_two_parts, in_two_parts.tetrahedra[t])[2] > 2 * kCell_m) continue;
        if (centroid(in_two_parts, in_two_parts.tetrahedra[t])[2] < kCell_m) continue;
        in_two_parts.tetrahedra.erase(in_two_parts.tetrahedra.begin() + static_cast<std::ptrdiff_t>(t));
        in_two_parts.palette_index.erase(in_two_parts.palette_index.begin() + static_cast<std::ptrdiff_t>(t));
    }
    EXPECT_EQ(path_youngs_modulus_pa(in_two_parts), kSoft_pa);
}

// ---- Against trying every elasticity from the stiffest down
// ------------------------------------------------

/// Nodes that tetrahedra of at least `modulus_pa` connect to a fixed node: spreads until nothing changes.
std::set<std::uint32_t> connected(const Asset& asset, double modulus_pa) {
    std::set<std::uint32_t> reached;
    for (std::uint32_t i = asset.free_node_count; i < asset.nodes_m.size(); ++i)
        reached.insert(i);
    for (std::size_t before = asset.nodes_m.size() + 1; before != reached.size();) {
        before = reached.size();
        for (std::size_t t = 0; t < asset.tetrahedra.size(); ++t) {
            const Tetrahedron& corners = asset.tetrahedra[t];
            if (asset.palette[asset.palette_index[t]].youngs_modulus_pa < modulus_pa) continue;
            if (std::none_of(corners.begin(), corners.end(), [&](auto n) { return reached.count(n) > 0; }))
                continue;
            reached.insert(corners.begin(), corners.end());
        }
    }
    return reached;
}

double path_by_trying(const Asset& asset) {
    std::set<double, std::greater<>> moduli;
    for (const std::uint32_t index : asset.palette_index)
        moduli.insert(asset.palette[index].youngs_modulus_pa);
    for (const double modulus_pa : moduli) {
        const std::set<std::uint32_t> reached = connected(asset, modulus_pa);
        const auto is_reached = [&](std::uint32_t node) { return reached.count(node) > 0; };
        bool all = true;
        for (const ToolSet& tool : asset.tools)
            all = all && (tool.contact == ToolContact::bonded
                              ? std::any_of(tool.nodes.begin(), tool.nodes.end(), is_reached)
                              : std::all_of(tool.nodes.begin(), tool.nodes.end(), is_reached));
        if (all) return modulus_pa;
    }
    return *moduli.rbegin();
}

TEST(Path_of_the_force, Is_what_trying_every_elasticity_finds) {
    std::mt19937_64 random(5);
    std::set<double> found;
    for (int i = 0; i < 300; ++i) {
        Asset asset = cube_asset(3, ToolShape::plate, ToolContact::bonded);
        const std::uint64_t distinct = 2 + random() % 30;
        asset.palette.clear();
        for (std::uint64_t k = 0; k < distinct; ++k)
            asset.palette.push_back({static_cast<double>(1 + random() % 20), 0.3, 1000});
        for (std::uint32_t& index : asset.palette_index)
            index = static_cast<std::uint32_t>(random() % distinct);
        asset.tools.resize(1 + random() % 2, asset.tools[0]);
        for (ToolSet& tool : asset.tools) {
            tool.contact = random() % 2 == 0 ? ToolContact::bonded : ToolContact::frictionless;
            tool.nodes.clear();
            for (std::uint32_t n = 0; n < asset.free_node_count; ++n)
                if (random() % 8 == 0) tool.nodes.push_back(n);
            if (tool.nodes.empty()) tool.nodes.push_back(0);
        }
        const double path_pa = path_youngs_modulus_pa(asset);
        EXPECT_EQ(path_pa, path_by_trying(asset)) << "asset " << i;
        found.insert(path_pa);
    }
    EXPECT_GT(found.size(), 10u) << "the assets differ too little to test anything";
}

}  // namespace
}  // namespace knead::test
