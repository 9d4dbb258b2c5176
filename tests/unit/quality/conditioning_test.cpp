// SPDX-License-Identifier: Apache-2.0
#include "quality/conditioning.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "knead/formats/asset_object.h"
#include "reference/elastic_body.h"
#include "unit/runtime/block_asset.h"

namespace knead::tools {
namespace {

constexpr double kRounding = 1e-10;  // of sums over some hundred tetrahedra

bool moves_by_itself(const Asset& asset, std::uint32_t node) {
    const auto& bonded = asset.tools[0].nodes;
    return node < asset.free_node_count && std::find(bonded.begin(), bonded.end(), node) == bonded.end();
}

/// The sum over a node's tetrahedra of the largest eigenvalues of its diagonal blocks, from the reference
/// solver's stiffness.
TEST(Conditioning, Bounds_node_stiffness_as_the_reference_solver_has_it) {
    Asset asset = test::cube_asset(3, ToolShape::plate, ToolContact::bonded);
    test::make_heterogeneous(asset, 5);
    const MaterialObject object = object_of(asset);
    const ElasticBody body(object.mesh, object.material);
    std::vector<double> bound(asset.free_node_count, 0);
    for (std::size_t t = 0; t < body.tetrahedron_count(); ++t) {
        const Matrix12d k = body.stiffness_n_per_m(t, body.rest_positions_m(), Curvature::exact);
        for (int a = 0; a < 4; ++a) {
            const std::uint32_t node = body.nodes_of(t)[static_cast<std::size_t>(a)];
            if (!moves_by_itself(asset, node)) continue;
            bound[node] += Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(k.block<3, 3>(3 * a, 3 * a))
                               .eigenvalues()
                               .maxCoeff();
        }
    }
    double sum = 0, mass = 0, softest = 1e300, stiffest = 0;
    for (std::uint32_t n = 0; n < asset.free_node_count; ++n) {
        if (!moves_by_itself(asset, n)) continue;
        softest = std::min(softest, bound[n]);
        stiffest = std::max(stiffest, bound[n]);
        sum += bound[n];
        mass += body.lumped_mass_kg()[n];
    }
    const Conditioning found = condition_of(asset);
    EXPECT_NEAR(found.node_stiffness_spread, stiffest / softest, kRounding * stiffest / softest);
    EXPECT_NEAR(found.stiffness_over_mass_per_s2, sum / mass, kRounding * sum / mass);
}

TEST(Conditioning, Of_a_wave_takes_the_thinnest_and_stiffest_tetrahedron) {
    const Asset asset = test::cube_asset(4, ToolShape::plate, ToolContact::bonded);
    const double modulus_pa = 22e3 * 0.7 / (1.3 * 0.4);
    const double height_m = 0.025 / std::sqrt(2.0);  // of every Kuhn tetrahedron, on its largest face
    EXPECT_NEAR(condition_of(asset).fastest_crossing_s, height_m * std::sqrt(1000 / modulus_pa), 1e-9);
}

TEST(Conditioning, Of_the_papers_cubes_takes_the_sparse_inverse_at_1_ms_and_the_factor_at_20) {
    Asset asset = test::cube_asset(6, ToolShape::plate, ToolContact::bonded);
    const Conditioning found = condition_of(asset);
    EXPECT_EQ(found.preconditioner_at(1e-3), Preconditioner::sparse_inverse);
    EXPECT_EQ(found.preconditioner_at(20e-3), Preconditioner::factor);
}

}  // namespace
}  // namespace knead::tools
