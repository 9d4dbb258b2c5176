// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>

#include "knead/formats/tet_mesh.h"

namespace knead::test {

/// A box [0, side]^3 of nx * ny * nz cells, each cut into the six tetrahedra that share the cell's diagonal
/// (Kuhn). Cells run x first, then y, then z. All volumes are positive. A helper of the tests that shares no
/// code with knead-mesh.
inline TetMesh kuhn_box(std::uint32_t nx, std::uint32_t ny, std::uint32_t nz, const Point& size_m) {
    TetMesh mesh;
    for (std::uint32_t z = 0; z <= nz; ++z)
        for (std::uint32_t y = 0; y <= ny; ++y)
            for (std::uint32_t x = 0; x <= nx; ++x)
                mesh.nodes_m.push_back({size_m[0] * x / nx, size_m[1] * y / ny, size_m[2] * z / nz});
    const std::array<std::uint32_t, 3> step{1, nx + 1, (nx + 1) * (ny + 1)};
    constexpr std::array<std::array<int, 3>, 6> kPaths{
        {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};  // the first three are even
    for (std::uint32_t z = 0; z < nz; ++z)
        for (std::uint32_t y = 0; y < ny; ++y)
            for (std::uint32_t x = 0; x < nx; ++x)
                for (std::size_t path = 0; path < kPaths.size(); ++path) {
                    Tetrahedron t{};
                    t[0] = x * step[0] + y * step[1] + z * step[2];
                    for (std::size_t i = 0; i < 3; ++i)
                        t[i + 1] = t[i] + step[static_cast<std::size_t>(kPaths[path][i])];
                    if (path >= 3) std::swap(t[1], t[2]);
                    mesh.tetrahedra.push_back(t);
                }
    return mesh;
}

/// The paper's cube: n^3 cells, side 0.1 m.
inline TetMesh kuhn_cube(std::uint32_t n, double side_m = 0.1) {
    return kuhn_box(n, n, n, {side_m, side_m, side_m});
}

/// Moves every node by at most `share` of a cell's side in each direction, so that no two tetrahedra are
/// alike. Below about 0.15 every volume stays positive.
inline void jitter(TetMesh& mesh, double cell_side_m, double share, std::uint64_t seed) {
    std::mt19937_64 engine(seed);
    for (Point& node : mesh.nodes_m)
        for (double& coordinate : node)
            coordinate +=
                cell_side_m * share * (2.0 * static_cast<double>(engine() >> 11U) * 0x1.0p-53 - 1.0);
}

}  // namespace knead::test
