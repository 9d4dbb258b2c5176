// SPDX-License-Identifier: Apache-2.0
#include "overlap/overlap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "common/error.h"
#include "overlap/coverage.h"
#include "unit/overlap/meshes.h"

namespace knead::test {
namespace {

using tools::Coverage;
using tools::coverage_of;
using tools::overlap_volumes;
using tools::OverlapOptions;
using tools::OverlapStatistics;

constexpr double kSide = 0.1;
/// Issue: rows and columns sum to the covered volume to 1e-12 relative.
constexpr double kSumTolerance = 1e-12;

void expect_sums_of_full_cover(const OverlapMatrix& overlap, const TetMesh& fine, const TetMesh& coarse) {
    std::vector<double> of_fine(fine.tetrahedra.size());
    for (std::size_t j = 0; j < coarse.tetrahedra.size(); ++j) {
        double of_coarse = 0;
        for (auto entry = overlap.row_offsets[j]; entry < overlap.row_offsets[j + 1]; ++entry) {
            of_coarse += overlap.volumes_m3[entry];
            of_fine[overlap.columns[entry]] += overlap.volumes_m3[entry];
        }
        const double volume = signed_volume_m3(coarse, j);
        EXPECT_NEAR(of_coarse, volume, kSumTolerance * volume) << "coarse " << j;
    }
    for (std::size_t i = 0; i < of_fine.size(); ++i) {
        const double volume = signed_volume_m3(fine, i);
        EXPECT_NEAR(of_fine[i], volume, kSumTolerance * volume) << "fine " << i;
    }
}

void expect_invariants(const OverlapMatrix& overlap) {
    ASSERT_EQ(overlap.row_offsets.size(), overlap.coarse_count + 1U);
    ASSERT_EQ(overlap.row_offsets.back(), overlap.columns.size());
    for (std::size_t j = 0; j < overlap.coarse_count; ++j)
        for (auto entry = overlap.row_offsets[j]; entry < overlap.row_offsets[j + 1]; ++entry) {
            EXPECT_LT(overlap.columns[entry], overlap.fine_count);
            EXPECT_GT(overlap.volumes_m3[entry], 0);
            if (entry > overlap.row_offsets[j]) {
                EXPECT_LT(overlap.columns[entry - 1], overlap.columns[entry]);
            }
        }
}

class OverlapOfCubes : public testing::TestWithParam<std::pair<int, int>> {};

TEST_P(OverlapOfCubes, has_rows_and_columns_that_sum_to_the_volumes) {
    const auto [n_fine, n_coarse] = GetParam();
    const TetMesh fine = cube_mesh(n_fine, kSide);
    const TetMesh coarse = cube_mesh(n_coarse, kSide);
    const OverlapMatrix overlap = overlap_volumes(fine, coarse, {});
    expect_invariants(overlap);
    expect_sums_of_full_cover(overlap, fine, coarse);
}

TEST_P(OverlapOfCubes, with_moved_inner_nodes_has_rows_and_columns_that_sum_to_the_volumes) {
    const auto [n_fine, n_coarse] = GetParam();
    const TetMesh fine = jittered(cube_mesh(n_fine, kSide), n_fine, kSide, 0.1, 1);
    const TetMesh coarse = jittered(cube_mesh(n_coarse, kSide), n_coarse, kSide, 0.1, 2);
    expect_sums_of_full_cover(overlap_volumes(fine, coarse, {}), fine, coarse);
}

INSTANTIATE_TEST_SUITE_P(sizes, OverlapOfCubes,
                         testing::Values(std::pair{10, 6}, std::pair{10, 8}, std::pair{6, 10},
                                         std::pair{12, 1}),
                         [](const auto& sizes) {
                             return std::to_string(sizes.param.first) + "_" +
                                    std::to_string(sizes.param.second);
                         });

TEST(Overlap_of_a_mesh_with_itself, is_the_diagonal_of_its_volumes) {
    const TetMesh mesh = cube_mesh(5, kSide);
    const OverlapMatrix overlap = overlap_volumes(mesh, mesh, {});
    ASSERT_EQ(overlap.columns.size(), mesh.tetrahedra.size()) << "pairs that only touch must not be stored";
    for (std::uint32_t j = 0; j < overlap.coarse_count; ++j) {
        EXPECT_EQ(overlap.columns[j], j);
        EXPECT_NEAR(overlap.volumes_m3[j], signed_volume_m3(mesh, j), kSumTolerance * overlap.volumes_m3[j]);
    }
}

TEST(Overlap_of_meshes_far_from_the_origin, is_that_of_meshes_at_the_origin) {
    const auto at = [](int n, double offset) {
        return rigidly_moved(cube_mesh(n, 1.0), 0, {offset, 0, -offset});
    };
    constexpr double kFar = 1024;  // a power of two: the nodes of a 1/4 lattice are shifted without rounding
    const OverlapMatrix near = overlap_volumes(at(4, 0), at(2, 0), {});
    const OverlapMatrix far = overlap_volumes(at(4, kFar), at(2, kFar), {});
    EXPECT_EQ(near.columns, far.columns);
    EXPECT_THAT(far.volumes_m3,
                testing::Pointwise(testing::DoubleNear(kSumTolerance * near.volumes_m3[0]), near.volumes_m3));
}

TEST(Overlap_of_very_small_and_very_large_meshes, scales_with_the_cube_of_the_size) {
    const OverlapMatrix unit = overlap_volumes(cube_mesh(3, 1.0), cube_mesh(2, 1.0), {});
    for (const int exponent : {-200, -40, 40, 200}) {  // 2^-600 and 2^600 cubic metres
        const double side = std::ldexp(1.0, exponent);
        const OverlapMatrix scaled = overlap_volumes(cube_mesh(3, side), cube_mesh(2, side), {});
        EXPECT_EQ(scaled.columns, unit.columns);
        for (std::size_t entry = 0; entry < unit.volumes_m3.size(); ++entry)
            EXPECT_EQ(scaled.volumes_m3[entry], std::ldexp(unit.volumes_m3[entry], 3 * exponent));
    }
}

TEST(Overlap_with_any_number_of_threads, is_the_same_to_the_last_bit) {
    const TetMesh fine = jittered(cube_mesh(9, kSide), 9, kSide, 0.2, 3);
    const TetMesh coarse = cube_mesh(6, kSide);
    const OverlapMatrix one = overlap_volumes(fine, coarse, {.threads = 1});
    for (const unsigned threads : {2U, 3U, 8U}) {
        const OverlapMatrix many = overlap_volumes(fine, coarse, {.threads = threads});
        EXPECT_EQ(many.row_offsets, one.row_offsets);
        EXPECT_EQ(many.columns, one.columns);
        EXPECT_EQ(many.volumes_m3, one.volumes_m3);
    }
}

TEST(Overlap_drop_below, leaves_out_exactly_the_smaller_shares) {
    constexpr double kRatio = 0.05;
    const TetMesh fine = cube_mesh(5, kSide);
    const TetMesh coarse = cube_mesh(3, kSide);
    const OverlapMatrix all = overlap_volumes(fine, coarse, {});
    const OverlapMatrix large = overlap_volumes(fine, coarse, {.drop_below = kRatio});
    const double fine_volume = signed_volume_m3(fine, 0);  // all alike, and smaller than the coarse ones
    std::vector<double> expected;
    for (const double volume : all.volumes_m3)
        if (volume > kRatio * fine_volume) expected.push_back(volume);
    EXPECT_LT(expected.size(), all.volumes_m3.size());
    EXPECT_EQ(large.volumes_m3, expected);
}

TEST(Overlap_drop_below, is_refused_out_of_its_range) {
    const TetMesh mesh = cube_mesh(1, kSide);
    for (const double ratio : {-1e-300, -1.0, 1.0, std::nan("")})
        EXPECT_THROW((void)overlap_volumes(mesh, mesh, {.drop_below = ratio}), tools::ToolError) << ratio;
}

TEST(Overlap_of_meshes_apart, is_empty) {
    const TetMesh mesh = cube_mesh(2, kSide);
    const OverlapMatrix overlap = overlap_volumes(mesh, rigidly_moved(mesh, 0, {kSide, 0, 0}), {});
    EXPECT_TRUE(overlap.columns.empty()) << "the cubes share a face only";
    EXPECT_EQ(overlap.row_offsets.size(), mesh.tetrahedra.size() + 1);
}

TEST(Overlap_of_a_mesh_whose_elements_are_larger_than_the_other_ones, is_found_too) {
    const TetMesh large = cube_mesh(1, kSide);
    const TetMesh small = cube_mesh(4, kSide / 2);
    const OverlapMatrix overlap = overlap_volumes(large, small, {});
    double sum = 0;
    for (const double volume : overlap.volumes_m3)
        sum += volume;
    EXPECT_NEAR(sum, std::pow(kSide / 2, 3), kSumTolerance * sum);
}

TEST(Coverage_of_equal_cubes, is_full_on_both_sides) {
    const TetMesh fine = cube_mesh(6, kSide);
    const TetMesh coarse = cube_mesh(4, kSide);
    const Coverage coverage = coverage_of(overlap_volumes(fine, coarse, {}), fine, coarse, 2);
    for (const auto& mesh : {coverage.fine, coverage.coarse}) {
        EXPECT_NEAR(mesh.covered_share, 1, kSumTolerance);
        EXPECT_LE(mesh.largest_full_error, kSumTolerance);
        EXPECT_EQ(mesh.incomplete.count, 0U);
        EXPECT_EQ(mesh.overlapped.count, 0U);
    }
    EXPECT_EQ(coverage.fine.full, fine.tetrahedra.size());
    EXPECT_EQ(coverage.coarse.full, coarse.tetrahedra.size());
}

TEST(Coverage_of_a_shifted_cube, names_the_elements_outside) {
    const TetMesh fine = cube_mesh(4, kSide);  // shifted by one of four layers
    const TetMesh coarse = rigidly_moved(cube_mesh(2, kSide), 0, {0, 0, kSide / 4});
    const Coverage coverage = coverage_of(overlap_volumes(fine, coarse, {}), fine, coarse, 1);
    EXPECT_NEAR(coverage.fine.covered_share, 0.75, kSumTolerance);
    EXPECT_NEAR(coverage.coarse.covered_share, 0.75, kSumTolerance);
    EXPECT_EQ(coverage.fine.uncovered.count, 4U * 4U * 6U);
    EXPECT_THAT(coverage.fine.uncovered.first, testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
    EXPECT_EQ(coverage.coarse.uncovered.count, 0U);
    EXPECT_EQ(coverage.coarse.incomplete.count, 2U * 2U * 6U);
}

TEST(Coverage_by_a_mesh_that_overlaps_itself, names_the_elements_covered_more_than_once) {
    const TetMesh fine = cube_mesh(2, kSide);
    TetMesh coarse = cube_mesh(1, kSide);
    coarse.tetrahedra.push_back(coarse.tetrahedra.front());
    const Coverage coverage = coverage_of(overlap_volumes(fine, coarse, {}), fine, coarse, 1);
    EXPECT_EQ(coverage.fine.overlapped.count, 8U);  // an eighth the size: eight of them fill the doubled one
    EXPECT_EQ(coverage.coarse.overlapped.count, 0U);
    EXPECT_LE(coverage.fine.covered_share, 1);
}

}  // namespace
}  // namespace knead::test
