// SPDX-License-Identifier: Apache-2.0
#include "coarsen/coarsen.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "common/error.h"
#include "support/kuhn_cube.h"

namespace knead::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using namespace tools;

constexpr double kRounding = 1e-12;

/// A row of tetrahedra of volume 1/6 side by side; only volumes and barycentres matter here.
TetMesh row(std::size_t count) {
    TetMesh mesh;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double x = 2.0 * i;
        mesh.nodes_m.insert(mesh.nodes_m.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, 1}});
        mesh.tetrahedra.push_back({4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3});
    }
    return mesh;
}

/// Four fine tetrahedra: two soft, a medium and a stiff one.
MaterialObject fine_four() {
    return {row(4), {{1e3, 1e3, 5e3, 9e3}, {.2, .2, .3, .4}, {900, 900, 1000, 1200}, {0, 0, 1, 2}}};
}

/// Overlap in shares of one tetrahedron's volume, written as dense rows.
OverlapMatrix shares(std::uint32_t fine_count, const std::vector<std::vector<double>>& rows) {
    OverlapMatrix overlap{static_cast<std::uint32_t>(rows.size()), fine_count, {0}, {}, {}};
    for (const auto& row_shares : rows) {
        for (std::uint32_t column = 0; column < row_shares.size(); ++column) {
            if (row_shares[column] == 0) continue;
            overlap.columns.push_back(column);
            overlap.volumes_m3.push_back(row_shares[column] / 6);
        }
        overlap.row_offsets.push_back(overlap.columns.size());
    }
    return overlap;
}

TEST(Coarsen, Dominant_compares_the_summed_volume_of_each_bin) {
    // Row 0: soft 0.3 + 0.2 beats stiff 0.4. Row 1: medium 0.6 beats soft 0.3.
    const OverlapMatrix overlap = shares(4, {{.3, .2, .1, .4}, {.3, 0, .6, 0}});
    const CoarsenResult result = coarsen(fine_four(), row(2), overlap, CoarsenRule::dominant);
    EXPECT_THAT(result.material.bin_of_tetrahedron, ElementsAre(0, 1));
    EXPECT_THAT(result.material.youngs_modulus_pa, ElementsAre(1e3, 5e3));
    EXPECT_THAT(result.material.poissons_ratio, ElementsAre(.2, .3));
    EXPECT_THAT(result.material.density_kg_per_m3, ElementsAre(900, 1000));
}

TEST(Coarsen, Dominant_without_bins_groups_tetrahedra_with_the_very_same_values) {
    MaterialObject fine = fine_four();
    fine.material.bin_of_tetrahedron.clear();
    const OverlapMatrix overlap = shares(4, {{.3, .2, .1, .4}});
    const CoarsenResult result = coarsen(fine, row(1), overlap, CoarsenRule::dominant);
    EXPECT_THAT(result.material.youngs_modulus_pa, ElementsAre(1e3));
    EXPECT_THAT(result.material.bin_of_tetrahedron, IsEmpty());
    fine.material.density_kg_per_m3[1] = 901;  // no longer the same material
    EXPECT_THAT(coarsen(fine, row(1), overlap, CoarsenRule::dominant).material.youngs_modulus_pa,
                ElementsAre(9e3));
}

TEST(Coarsen, Dominant_tie_goes_to_the_stiffer_even_when_rounding_hides_it) {
    const CoarsenResult exact =
        coarsen(fine_four(), row(1), shares(4, {{.25, .25, 0, .5}}), CoarsenRule::dominant);
    EXPECT_THAT(exact.material.bin_of_tetrahedron, ElementsAre(2));
    const CoarsenResult rounded =
        coarsen(fine_four(), row(1), shares(4, {{.25, .25 + 1e-15, 0, .5 - 1e-15}}), CoarsenRule::dominant);
    EXPECT_THAT(rounded.material.bin_of_tetrahedron, ElementsAre(2));
    const CoarsenResult clear =
        coarsen(fine_four(), row(1), shares(4, {{.25, .25 + 1e-6, 0, .5 - 1e-6}}), CoarsenRule::dominant);
    EXPECT_THAT(clear.material.bin_of_tetrahedron, ElementsAre(0));
}

TEST(Coarsen, Dominant_tie_does_not_depend_on_the_order_of_the_tetrahedra) {
    const MaterialObject stiff_first{row(2), {{9e3, 1e3}, {.3, .3}, {1000, 1000}, {1, 0}}};
    const CoarsenResult result = coarsen(stiff_first, row(1), shares(2, {{.5, .5}}), CoarsenRule::dominant);
    EXPECT_THAT(result.material.bin_of_tetrahedron, ElementsAre(1));
}

TEST(Coarsen, Volume_average_is_over_the_covered_volume_and_has_no_bins) {
    const CoarsenResult result =
        coarsen(fine_four(), row(1), shares(4, {{.1, 0, .2, .3}}), CoarsenRule::volume_average);
    const double expected = (.1 * 1e3 + .2 * 5e3 + .3 * 9e3) / .6;
    EXPECT_NEAR(result.material.youngs_modulus_pa[0], expected, expected * kRounding);
    EXPECT_NEAR(result.material.poissons_ratio[0], (.1 * .2 + .2 * .3 + .3 * .4) / .6, kRounding);
    EXPECT_NEAR(result.material.density_kg_per_m3[0], (.1 * 900 + .2 * 1000 + .3 * 1200) / .6,
                1200 * kRounding);
    EXPECT_THAT(result.material.bin_of_tetrahedron, IsEmpty());
}

TEST(Coarsen, Same_mesh_gives_back_the_same_values_with_both_rules) {
    MaterialObject fine{kuhn_cube(3), {}};
    jitter(fine.mesh, 0.1 / 3, 0.1, 7);
    OverlapMatrix overlap{162, 162, {0}, {}, {}};
    for (std::uint32_t t = 0; t < 162; ++t) {
        overlap.columns.push_back(t);
        overlap.volumes_m3.push_back(signed_volume_m3(fine.mesh, t));
        overlap.row_offsets.push_back(t + 1);
        fine.material.youngs_modulus_pa.push_back(1234.5678 + 17.3 * t);
        fine.material.poissons_ratio.push_back(0.3 + 0.0001 * t);
        fine.material.density_kg_per_m3.push_back(1000.1 + t);
    }
    for (const CoarsenRule rule : {CoarsenRule::dominant, CoarsenRule::volume_average}) {
        const CoarsenResult result = coarsen(fine, fine.mesh, overlap, rule);
        EXPECT_EQ(result.material.youngs_modulus_pa, fine.material.youngs_modulus_pa);
        EXPECT_EQ(result.material.poissons_ratio, fine.material.poissons_ratio);
        EXPECT_EQ(result.material.density_kg_per_m3, fine.material.density_kg_per_m3);
        EXPECT_NEAR(result.coverage.coarse_share, 1, kRounding);
        EXPECT_NEAR(result.coverage.fine_share, 1, kRounding);
        EXPECT_THAT(result.coverage.coarse_missing, IsEmpty());
    }
}

TEST(Coarsen, An_uncovered_coarse_tetrahedron_takes_the_nearest_fine_one) {
    // Coarse tetrahedron 2 has no overlap; fine tetrahedron 2 stands at its place.
    const OverlapMatrix overlap = shares(4, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 0}});
    for (const CoarsenRule rule : {CoarsenRule::dominant, CoarsenRule::volume_average}) {
        const CoarsenResult result = coarsen(fine_four(), row(3), overlap, rule);
        EXPECT_THAT(result.material.youngs_modulus_pa, ElementsAre(1e3, 1e3, 5e3));
        EXPECT_THAT(result.material.poissons_ratio, ElementsAre(.2, .2, .3));
        EXPECT_THAT(result.coverage.coarse_uncovered, ElementsAre(2));
        EXPECT_EQ(result.material.bin_of_tetrahedron.size(), rule == CoarsenRule::dominant ? 3U : 0U);
    }
}

TEST(Coarsen, Coverage_counts_what_misses_more_than_one_percent) {
    const OverlapMatrix overlap = shares(4, {{.995, 0, 0, 0}, {0, .98, 0, 0}, {0, 0, .5, .1}});
    const CoveredShares coverage = coarsen(fine_four(), row(3), overlap, CoarsenRule::dominant).coverage;
    EXPECT_THAT(coverage.coarse_missing, ElementsAre(1, 2));
    EXPECT_THAT(coverage.fine_missing, ElementsAre(1, 2, 3));
    EXPECT_THAT(coverage.coarse_uncovered, IsEmpty());
    EXPECT_NEAR(coverage.coarse_share, (.995 + .98 + .6) / 3, kRounding);
    EXPECT_NEAR(coverage.fine_share, (.995 + .98 + .6) / 4, kRounding);
}

std::string bad_input(const std::function<void()>& call) {
    try {
        call();
    } catch (const ToolError& error) {
        EXPECT_EQ(error.code(), ExitCode::bad_input);
        return error.what();
    }
    return "no error";
}

TEST(Coarsen, An_overlap_of_other_meshes_is_refused) {
    const auto with = [](std::size_t coarse, const OverlapMatrix& overlap) {
        return bad_input([&] { (void)coarsen(fine_four(), row(coarse), overlap, CoarsenRule::dominant); });
    };
    EXPECT_THAT(with(2, shares(4, {{1, 0, 0, 0}})), HasSubstr("1 coarse tetrahedra, the coarse mesh has 2"));
    EXPECT_THAT(with(1, shares(5, {{1, 0, 0, 0}})), HasSubstr("5 fine tetrahedra, the fine mesh has 4"));
    EXPECT_THAT(with(2, shares(4, {{.5, 0, 0, 0}, {.2, .9, 0, 0}})),
                HasSubstr("1 of 2 coarse tetrahedra more volume than they have (counted from 0: 1)"));
    EXPECT_THAT(with(2, shares(4, {{0, 0, .9, 0}, {0, 0, .2, 0}})),
                HasSubstr("1 of 4 fine tetrahedra more volume than they have (counted from 0: 2)"));
    EXPECT_EQ(with(2, shares(4, {{1 + 1e-9, 0, 0, 0}, {0, 1, 0, 0}})), "no error");  // rounding
}

}  // namespace
}  // namespace knead::test
