// SPDX-License-Identifier: Apache-2.0
#include "unit/overlap/meshes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "support/kuhn_cube.h"

namespace knead::test {

TetMesh cube_mesh(int n, double side_m) {
    return kuhn_cube(static_cast<std::uint32_t>(n), side_m);
}

TetMesh jittered(TetMesh mesh, int n, double side_m, double share, std::uint64_t seed) {
    std::mt19937_64 bits(seed);
    for (Point& p : mesh.nodes_m) {
        const bool inner = std::all_of(p.begin(), p.end(), [&](double x) { return x > 0 && x < side_m; });
        for (double& x : p) {
            const double random = static_cast<double>(bits() >> 11) * 0x1p-52 - 1;
            if (inner) x += random * share * side_m / n;
        }
    }
    return mesh;
}

TetMesh rigidly_moved(TetMesh mesh, double angle_rad, const Point& shift_m) {
    const double length = std::sqrt(14.0);
    const Point u{1 / length, 2 / length, 3 / length};
    const double c = std::cos(angle_rad);
    const double s = std::sin(angle_rad);
    for (Point& p : mesh.nodes_m) {
        const double along = u[0] * p[0] + u[1] * p[1] + u[2] * p[2];
        const Point cross{u[1] * p[2] - u[2] * p[1], u[2] * p[0] - u[0] * p[2], u[0] * p[1] - u[1] * p[0]};
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = c * p[axis] + s * cross[axis] + (1 - c) * along * u[axis] + shift_m[axis];
    }
    return mesh;
}

}  // namespace knead::test
