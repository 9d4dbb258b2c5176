// SPDX-License-Identifier: Apache-2.0
#include "bake/surface.h"

#include <gtest/gtest.h>

#include "support/kuhn_cube.h"

namespace knead::tools {
namespace {

/// Volume enclosed by outward triangles (divergence theorem).
double enclosed_volume_m3(const TetMesh& mesh, const std::vector<Triangle>& triangles) {
    double volume = 0;
    for (const Triangle& t : triangles)
        volume += signed_volume_m3({0, 0, 0}, mesh.nodes_m[t[0]], mesh.nodes_m[t[1]], mesh.nodes_m[t[2]]);
    return volume;
}

TEST(BoundaryTriangles, Of_a_box_are_twelve_per_cell_face_pair_and_enclose_its_volume) {
    const TetMesh mesh = test::kuhn_box(3, 2, 4, {0.3, 0.2, 0.4});
    const auto triangles = boundary_triangles(mesh.tetrahedra);
    EXPECT_EQ(triangles.size(), 2u * 2u * (3 * 2 + 2 * 4 + 3 * 4));
    EXPECT_NEAR(enclosed_volume_m3(mesh, triangles), 0.3 * 0.2 * 0.4, 1e-12);
}

}  // namespace
}  // namespace knead::tools
