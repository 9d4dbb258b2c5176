// SPDX-License-Identifier: Apache-2.0
#include "bake/node_order.h"

#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <future>
#include <numeric>

#include "support/kuhn_cube.h"

namespace knead::tools {
namespace {

/// Entries of the Cholesky factor of the nodes' graph in this order; counted by Eigen.
Eigen::Index factor_entries(const TetMesh& mesh, const std::vector<std::uint32_t>& order) {
    std::vector<int> place(mesh.nodes_m.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        place[order[i]] = static_cast<int>(i);
    std::vector<Eigen::Triplet<double>> entries;
    for (const Tetrahedron& t : mesh.tetrahedra)
        for (const std::uint32_t a : t)
            for (const std::uint32_t b : t)
                entries.emplace_back(place[a], place[b], a == b ? 10.0 : -0.1);
    const auto n = static_cast<Eigen::Index>(order.size());
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>> factor(
        matrix);
    EXPECT_EQ(factor.info(), Eigen::Success);
    return Eigen::SparseMatrix<double>(factor.matrixL()).nonZeros();
}

TEST(NodeOrder, Holds_each_free_node_once) {
    const TetMesh mesh = test::kuhn_cube(4);
    std::vector<bool> free(mesh.nodes_m.size());
    for (std::size_t i = 0; i < free.size(); ++i)
        free[i] = i % 3 != 0;
    auto order = nested_dissection_order(mesh.tetrahedra, free);
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < free.size(); ++i)
        if (free[i]) expected.push_back(i);
    EXPECT_EQ(order, expected);
}

TEST(NodeOrder, Fills_the_factor_less_than_the_order_of_the_mesh) {
    const TetMesh mesh = test::kuhn_cube(10);
    const auto order = nested_dissection_order(mesh.tetrahedra, std::vector<bool>(mesh.nodes_m.size(), true));
    std::vector<std::uint32_t> natural(mesh.nodes_m.size());
    std::iota(natural.begin(), natural.end(), 0U);
    EXPECT_LT(factor_entries(mesh, order), factor_entries(mesh, natural) * 6 / 10);
}

TEST(NodeOrder, Of_the_same_mesh_is_the_same) {
    const TetMesh mesh = test::kuhn_cube(6);
    const std::vector<bool> free(mesh.nodes_m.size(), true);
    EXPECT_EQ(nested_dissection_order(mesh.tetrahedra, free), nested_dissection_order(mesh.tetrahedra, free));
}

TEST(NodeOrder, Of_the_same_mesh_is_the_same_beside_others_that_are_ordered_at_the_time) {
    const TetMesh mesh = test::kuhn_cube(6);
    const std::vector<bool> free(mesh.nodes_m.size(), true);
    const auto alone = nested_dissection_order(mesh.tetrahedra, free);
    std::vector<std::future<bool>> orders;
    for (int thread = 0; thread < 4; ++thread) {
        orders.push_back(std::async(std::launch::async, [&] {
            bool same = true;
            for (int k = 0; k < 25; ++k)
                same = same && nested_dissection_order(mesh.tetrahedra, free) == alone;
            return same;
        }));
    }
    for (auto& order : orders)
        EXPECT_TRUE(order.get());
}

TEST(NodeOrder, Of_nodes_without_neighbours_is_their_own_order) {
    const TetMesh mesh = test::kuhn_cube(1);
    std::vector<bool> free(mesh.nodes_m.size(), false);
    free[5] = true;
    EXPECT_EQ(nested_dissection_order(mesh.tetrahedra, free), std::vector<std::uint32_t>{5});
}

}  // namespace
}  // namespace knead::tools
