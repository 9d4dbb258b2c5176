// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "common/error.h"
#include "mesh/geometry.h"

namespace knead::tools {
namespace {

/// Sums of about 1e4 volumes of equal size: 1e4 roundings of 1e-16 each, with room.
constexpr double kVolumeTolerance = 1e-12;

/// Volume by the determinant, written apart from formats' own.
double volume(const TetMesh& mesh, const Tetrahedron& t) {
    std::array<std::array<double, 3>, 3> m{};
    for (int row = 0; row < 3; ++row)
        for (int axis = 0; axis < 3; ++axis)
            m[row][axis] = mesh.nodes_m[t[row + 1]][axis] - mesh.nodes_m[t[0]][axis];
    return (m[0][0] * m[1][1] * m[2][2] + m[0][1] * m[1][2] * m[2][0] + m[0][2] * m[1][0] * m[2][1] -
            m[0][2] * m[1][1] * m[2][0] - m[0][1] * m[1][0] * m[2][2] - m[0][0] * m[1][2] * m[2][1]) /
           6;
}

TEST(Cubes, Of_ten_eight_and_six_divisions_have_the_counts_of_the_paper) {
    const std::map<std::uint32_t, std::size_t> counts{{10, 6000}, {8, 3072}, {6, 1296}};
    for (const auto& [n, count] : counts) {
        const TetMesh mesh = make_cubes({n, n, n}, {0.1, 0.1, 0.1});
        EXPECT_EQ(mesh.tetrahedra.size(), count);
        EXPECT_EQ(mesh.nodes_m.size(), (n + 1) * (n + 1) * (n + 1));
    }
}

TEST(Cubes, Have_equal_positive_volumes_that_sum_to_the_box) {
    const TetMesh mesh = make_cubes({3, 4, 5}, {0.3, 0.2, 0.1});
    const double each = 0.3 * 0.2 * 0.1 / (6 * 60);
    double sum = 0;
    for (const Tetrahedron& t : mesh.tetrahedra) {
        EXPECT_NEAR(volume(mesh, t), each, kVolumeTolerance * each * 100);
        sum += volume(mesh, t);
    }
    EXPECT_NEAR(sum, 0.3 * 0.2 * 0.1, kVolumeTolerance * sum);
}

TEST(Cubes, Are_a_ball_whose_surface_is_a_sphere_by_Eulers_formula) {
    const TetMesh mesh = make_cubes({2, 3, 4}, {1, 1, 1});
    std::set<std::array<std::uint32_t, 2>> edges;
    std::map<std::array<std::uint32_t, 3>, int> faces;
    for (const Tetrahedron& nodes : mesh.tetrahedra) {
        Tetrahedron t = nodes;
        std::sort(t.begin(), t.end());
        for (int i = 0; i < 4; ++i)
            for (int j = i + 1; j < 4; ++j)
                edges.insert({t[i], t[j]});
        for (int skip = 0; skip < 4; ++skip) {
            std::array<std::uint32_t, 3> face{};
            for (int i = 0, k = 0; i < 4; ++i)
                if (i != skip) face[k++] = t[i];
            ++faces[face];
        }
    }
    const auto count = [](std::size_t n) { return static_cast<long>(n); };
    EXPECT_EQ(count(mesh.nodes_m.size()) - count(edges.size()) + count(faces.size()) -
                  count(mesh.tetrahedra.size()),
              1);
    long outside = 0;
    for (const auto& [face, uses] : faces) {
        EXPECT_LE(uses, 2);
        outside += uses == 1 ? 1 : 0;
    }
    EXPECT_EQ(outside, 2 * 2 * (2 * 3 + 3 * 4 + 2 * 4));  // two triangles per outer square: the diagonals fit
}

TEST(Cubes, Split_every_sub_cube_along_the_same_main_diagonal) {
    const TetMesh mesh = make_cubes({2, 2, 2}, {2, 2, 2});
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
        const std::size_t cube = t / 6;
        const Point low{double(cube % 2), double(cube / 2 % 2), double(cube / 4)};
        const Point high{low[0] + 1, low[1] + 1, low[2] + 1};
        int corners = 0;
        for (const std::uint32_t node : mesh.tetrahedra[t])
            corners += mesh.nodes_m[node] == low || mesh.nodes_m[node] == high ? 1 : 0;
        EXPECT_EQ(corners, 2) << "tetrahedron " << t;
    }
}

TEST(Cubes, Number_nodes_with_x_fastest_and_end_exactly_at_the_size) {
    const TetMesh mesh = make_cubes({7, 3, 2}, {0.1, 0.3, 0.7});
    EXPECT_EQ(mesh.nodes_m[0], (Point{0, 0, 0}));
    EXPECT_EQ(mesh.nodes_m[1][1], 0);
    EXPECT_GT(mesh.nodes_m[1][0], 0);
    EXPECT_EQ(mesh.nodes_m[7][0], 0.1);
    EXPECT_EQ(mesh.nodes_m[8][0], 0);
    EXPECT_EQ(mesh.nodes_m.back(), (Point{0.1, 0.3, 0.7}));
}

TEST(Cubes, With_bad_values_are_refused) {
    const auto code = [](std::array<std::uint32_t, 3> n, std::array<double, 3> size) {
        try {
            (void)make_cubes(n, size);
        } catch (const ToolError& error) {
            return error.code();
        }
        return ExitCode::done;
    };
    EXPECT_EQ(code({0, 1, 1}, {1, 1, 1}), ExitCode::bad_usage);
    EXPECT_EQ(code({1, 1, 1}, {1, 0, 1}), ExitCode::bad_usage);
    EXPECT_EQ(code({1, 1, 1}, {1, -1, 1}), ExitCode::bad_usage);
    EXPECT_EQ(code({1, 1, 1}, {1, NAN, 1}), ExitCode::bad_usage);
    EXPECT_EQ(code({4000000000U, 4000000000U, 4000000000U}, {1, 1, 1}), ExitCode::bad_usage);
    EXPECT_EQ(code({1, 1, 1}, {1, 1, 1}), ExitCode::done);
}

}  // namespace
}  // namespace knead::tools
