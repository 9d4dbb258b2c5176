// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

using Corners = std::array<Point, 4>;

/// Corners of the face opposite to each corner, ordered so that the normal points to that corner in a
/// tetrahedron of positive volume. The first one is the point the plane is measured from.
inline constexpr std::array<std::array<int, 3>, 4> kFaceOppositeTo{
    {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}}};

/// The four face planes of a tetrahedron, normals inward, not normalised. Indices: [axis][face].
template <class Number>
struct Faces {
    std::array<std::array<Number, 4>, 3> normal;
    std::array<std::array<Number, 4>, 3> origin;
};

template <class Number>
Faces<Number> faces_of(const Corners& corners) {
    Faces<Number> faces;
    for (int face = 0; face < 4; ++face) {
        const auto [a, b, c] = kFaceOppositeTo[face];
        std::array<Number, 3> u;
        std::array<Number, 3> v;
        for (int axis = 0; axis < 3; ++axis) {
            faces.origin[axis][face] = Number(corners[a][axis]);
            u[axis] = Number(corners[b][axis]) - Number(corners[a][axis]);
            v[axis] = Number(corners[c][axis]) - Number(corners[a][axis]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const int j = (axis + 1) % 3;
            const int k = (axis + 2) % 3;
            faces.normal[axis][face] = u[j] * v[k] - u[k] * v[j];
        }
    }
    return faces;
}

/// What is needed of a tetrahedron again and again, computed once.
struct PreparedTet {
    Corners corners;
    Faces<double> faces;
    /// [axis][face] what |normal| would be if nothing cancelled: the scale of its rounding error.
    std::array<std::array<double, 4>, 3> normal_scale;
    Point low;  ///< bounding box
    Point high;
    double volume = 0;  ///< relative error below 4e-13 whatever the shape
};

/// @param corners of positive volume; coordinates of a size that neither overflows nor underflows when cubed
[[nodiscard]] PreparedTet prepare(const Corners& corners);

/// Tetrahedra of a mesh, every coordinate multiplied by 2^-exponent.
[[nodiscard]] std::vector<PreparedTet> prepare_all(const TetMesh& mesh, int exponent, unsigned threads);

/// Volumes of the tetrahedra of a mesh, each with a relative error below 4e-13 whatever its shape.
[[nodiscard]] std::vector<double> accurate_volumes_m3(const TetMesh& mesh, unsigned threads);

/// Binary exponent of the largest coordinate of a mesh: scaling by a power of two is exact.
[[nodiscard]] int exponent_of(const TetMesh& mesh);

}  // namespace knead::tools
