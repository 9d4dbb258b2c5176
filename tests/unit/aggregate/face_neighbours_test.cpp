// SPDX-License-Identifier: Apache-2.0
#include "aggregate/face_neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using namespace tools;

TEST(Face_neighbours, Two_tetrahedra_see_each_other_through_the_shared_face_only) {
    const FaceNeighbours neighbours = face_neighbours({{0, 1, 2, 3}, {0, 2, 1, 4}});
    EXPECT_EQ(neighbours[0], (std::array{kNoNeighbour, kNoNeighbour, kNoNeighbour, 1U}));
    EXPECT_EQ(neighbours[1], (std::array{kNoNeighbour, kNoNeighbour, kNoNeighbour, 0U}));
}

TEST(Face_neighbours, Of_a_cube_are_the_pairs_that_share_three_nodes) {
    const TetMesh mesh = kuhn_cube(3);
    const FaceNeighbours neighbours = face_neighbours(mesh.tetrahedra);
    for (std::uint32_t a = 0; a < mesh.tetrahedra.size(); ++a) {
        std::set<std::uint32_t> expected;
        const std::set<std::uint32_t> nodes(mesh.tetrahedra[a].begin(), mesh.tetrahedra[a].end());
        for (std::uint32_t b = 0; b < mesh.tetrahedra.size(); ++b) {
            const auto shared = std::count_if(mesh.tetrahedra[b].begin(), mesh.tetrahedra[b].end(),
                                              [&](std::uint32_t node) { return nodes.contains(node); });
            if (a != b && shared == 3) expected.insert(b);
        }
        std::set<std::uint32_t> found(neighbours[a].begin(), neighbours[a].end());
        found.erase(kNoNeighbour);
        EXPECT_EQ(found, expected) << a;
    }
}

TEST(Face_neighbours, Face_is_opposite_the_node_of_the_same_number) {
    const TetMesh mesh = kuhn_cube(2);
    const FaceNeighbours neighbours = face_neighbours(mesh.tetrahedra);
    for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t)
        for (std::size_t face = 0; face < 4; ++face) {
            if (neighbours[t][face] == kNoNeighbour) continue;
            const Tetrahedron& other = mesh.tetrahedra[neighbours[t][face]];
            EXPECT_EQ(std::count(other.begin(), other.end(), mesh.tetrahedra[t][face]), 0);
        }
}

TEST(Face_neighbours, A_face_of_three_tetrahedra_pairs_the_first_two) {
    const FaceNeighbours neighbours = face_neighbours({{0, 1, 2, 3}, {0, 2, 1, 4}, {0, 1, 2, 5}});
    EXPECT_EQ(neighbours[0][3], 1U);
    EXPECT_EQ(neighbours[1][3], 0U);
    EXPECT_EQ(neighbours[2][3], kNoNeighbour);
}

}  // namespace
}  // namespace knead::test
