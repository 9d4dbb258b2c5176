// SPDX-License-Identifier: Apache-2.0
#include "core/tet_strips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "knead/formats/tet_mesh.h"
#include "support/kuhn_cube.h"
#include "support/random.h"

namespace knead::core {
namespace {

/// Every tetrahedron once, on its own nodes. @return strips
std::vector<TetStrip> expect_cover(const std::vector<Tetrahedron>& tetrahedra) {
    std::vector<Element> elements(tetrahedra.size());
    for (std::size_t t = 0; t < tetrahedra.size(); ++t)
        elements[t].nodes = tetrahedra[t];
    const std::vector<TetStrip> strips = make_tet_strips(elements);
    std::vector<int> seen(tetrahedra.size(), 0);
    for (const TetStrip& strip : strips) {
        for (std::size_t k = 0; k < kTetsInStrip && strip.elements[k] != TetStrip::kNone; ++k) {
            ++seen[strip.elements[k]];
            Tetrahedron nodes{strip.nodes[0], strip.nodes[k + 1], strip.nodes[k + 2], strip.nodes[k + 3]};
            Tetrahedron expected = tetrahedra[strip.elements[k]];
            std::sort(nodes.begin(), nodes.end());
            std::sort(expected.begin(), expected.end());
            EXPECT_EQ(nodes, expected);
        }
    }
    EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
    return strips;
}

TEST(TetStrips, of_a_cube_of_cells_are_all_full) {
    EXPECT_EQ(expect_cover(test::kuhn_cube(4).tetrahedra).size(), 4U * 4U * 4U * 6U / 3U);
}

TEST(TetStrips, of_a_mesh_with_holes_are_nearly_all_full) {
    TetMesh mesh = test::kuhn_cube(6);
    test::Random random(1);
    const auto is_hole = [&](const Tetrahedron&) { return random.uniform(0, 1) < 0.2; };
    mesh.tetrahedra.erase(std::remove_if(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), is_hole),
                          mesh.tetrahedra.end());
    const std::size_t count = mesh.tetrahedra.size();
    EXPECT_LT(static_cast<double>(expect_cover(mesh.tetrahedra).size()),
              1.06 * static_cast<double>(count) / 3);
}

TEST(TetStrips, of_tetrahedra_in_a_row_are_repaired_until_full) {
    // A chain of six whose numbering invites the greedy choice to leave ends over.
    EXPECT_EQ(
        expect_cover({{2, 3, 4, 5}, {0, 1, 2, 3}, {5, 6, 7, 8}, {1, 2, 3, 4}, {4, 5, 6, 7}, {3, 4, 5, 6}})
            .size(),
        2U);
}

TEST(TetStrips, of_a_star_are_one_full_and_two_singles) {
    EXPECT_EQ(expect_cover({{0, 1, 2, 3}, {0, 1, 2, 4}, {0, 1, 3, 5}, {0, 2, 3, 6}, {1, 2, 3, 7}}).size(),
              3U);
}

TEST(TetStrips, of_a_ring_round_an_edge_are_one) {
    EXPECT_EQ(expect_cover({{0, 1, 2, 3}, {0, 1, 3, 4}, {0, 1, 4, 2}}).size(), 1U);
}

TEST(TetStrips, of_nothing_are_none) {
    EXPECT_TRUE(make_tet_strips({}).empty());
}

}  // namespace
}  // namespace knead::core
