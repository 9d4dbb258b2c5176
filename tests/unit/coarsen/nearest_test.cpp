// SPDX-License-Identifier: Apache-2.0
#include "coarsen/nearest.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

TEST(Nearest_barycentre, Agrees_with_a_look_at_every_tetrahedron) {
    TetMesh mesh = kuhn_cube(4);
    jitter(mesh, 0.025, 0.12, 2);
    const tools::NearestBarycentre nearest(mesh);
    std::mt19937_64 engine(3);
    for (int round = 0; round < 300; ++round) {
        Point point{};
        for (double& coordinate : point)
            coordinate = 0.3 * static_cast<double>(engine() >> 11U) * 0x1.0p-53 - 0.1;
        std::uint32_t expected = 0;
        double shortest = std::numeric_limits<double>::infinity();
        for (std::uint32_t t = 0; t < mesh.tetrahedra.size(); ++t) {
            const Point centre = barycentre_m(mesh, t);
            const double distance =
                std::hypot(centre[0] - point[0], centre[1] - point[1], centre[2] - point[2]);
            if (distance < shortest) {
                shortest = distance;
                expected = t;
            }
        }
        EXPECT_EQ(nearest(point), expected);
    }
}

TEST(Nearest_barycentre, Ties_go_to_the_lower_index) {
    TetMesh mesh = kuhn_cube(1);
    mesh.tetrahedra = {mesh.tetrahedra[3], mesh.tetrahedra[0], mesh.tetrahedra[0], mesh.tetrahedra[3]};
    const tools::NearestBarycentre nearest(mesh);
    EXPECT_EQ(nearest(barycentre_m(mesh, 2)), 1U);
    EXPECT_EQ(nearest(barycentre_m(mesh, 3)), 0U);
}

}  // namespace
}  // namespace knead::test
