// SPDX-License-Identifier: Apache-2.0
#include "stability/meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace knead::tools::stability {
namespace {

constexpr double kRounding = 1e-12;

double volume_m3(const TetMesh& mesh) {
    double sum = 0;
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
        sum += signed_volume_m3(mesh, t);
    return sum;
}

/// Area of the faces that belong to one tetrahedron only; of a mesh without gaps: that of its border.
double border_area_m2(const TetMesh& mesh) {
    std::map<std::array<std::uint32_t, 3>, int> faces;
    for (const Tetrahedron& t : mesh.tetrahedra)
        for (std::size_t k = 0; k < 4; ++k) {
            std::array<std::uint32_t, 3> face{t[(k + 1) % 4], t[(k + 2) % 4], t[(k + 3) % 4]};
            std::sort(face.begin(), face.end());
            ++faces[face];
        }
    double area = 0;
    for (const auto& [face, count] : faces) {
        EXPECT_LE(count, 2);
        if (count == 2) continue;
        std::array<double, 3> u{}, v{};
        for (std::size_t k = 0; k < 3; ++k) {
            u[k] = mesh.nodes_m[face[1]][k] - mesh.nodes_m[face[0]][k];
            v[k] = mesh.nodes_m[face[2]][k] - mesh.nodes_m[face[0]][k];
        }
        area +=
            0.5 * std::hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
    }
    return area;
}

TEST(StabilityMeshes, Box_fills_its_volume_without_gaps) {
    const TetMesh mesh = box_mesh({2, 3, 4}, {1, 2, 3});
    EXPECT_TRUE(validate(mesh).ok());
    EXPECT_NEAR(volume_m3(mesh), 6, kRounding);
    EXPECT_NEAR(border_area_m2(mesh), 22, 22 * kRounding);
}

TEST(StabilityMeshes, Graded_corner_fills_the_cube_without_gaps_and_has_edges_of_that_ratio) {
    const TetMesh mesh = graded_corner(1, 1024);
    EXPECT_TRUE(validate(mesh).ok());
    EXPECT_NEAR(volume_m3(mesh), 1, kRounding);
    EXPECT_NEAR(border_area_m2(mesh), 6, 6 * kRounding);
    double shortest = 1, longest = 0;
    for (const Tetrahedron& t : mesh.tetrahedra)
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const Point &a = mesh.nodes_m[t[i]], &b = mesh.nodes_m[t[j]];
                const double edge = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
                shortest = std::min(shortest, edge);
                longest = std::max(longest, edge);
            }
    EXPECT_GE(longest / shortest, 1000);
    EXPECT_GT(smallest_dihedral_rad(mesh), 10 * M_PI / 180) << "graded, not flat";
}

TEST(StabilityMeshes, Slivers_have_the_angle_that_is_asked_for_and_keep_the_volume) {
    const TetMesh box = box_mesh({2, 2, 2}, {1, 1, 1});
    for (const Flaw flaw : {Flaw::near_face, Flaw::near_edge})
        for (const double degrees : {10.0, 0.5}) {
            const TetMesh mesh = with_slivers(box, flaw, degrees * M_PI / 180, 10);
            EXPECT_TRUE(validate(mesh).ok());
            EXPECT_NEAR(volume_m3(mesh), 1, kRounding);
            EXPECT_NEAR(smallest_dihedral_rad(mesh) * 180 / M_PI, degrees, 1e-6);
            EXPECT_EQ(mesh.tetrahedra.size(), box.tetrahedra.size() + 3 * 5);
        }
}

TEST(StabilityMeshes, Islands_are_inside_and_apart_and_as_much_stiffer_as_asked) {
    const MaterialObject object = contrast_cube(5, 1, 0.3, 1e6, Layout::islands);
    const auto& e = object.material.youngs_modulus_pa;
    const double softest = *std::min_element(e.begin(), e.end());
    EXPECT_EQ(std::count(e.begin(), e.end(), 1e6 * softest), 8 * 6);
    EXPECT_EQ(std::count(e.begin(), e.end(), softest), static_cast<long>(e.size()) - 8 * 6);
}

}  // namespace
}  // namespace knead::tools::stability
