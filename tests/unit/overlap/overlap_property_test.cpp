// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "overlap/overlap.h"
#include "unit/overlap/meshes.h"

namespace knead::test {
namespace {

using tools::overlap_volumes;

constexpr double kSide = 0.1;
/// Sums of at most a few hundred volumes that are each good to 1e-12 of the smaller element, and in practice
/// to 1e-15.
constexpr double kSumTolerance = 1e-12;
/// Rotating rounds every coordinate, by up to 1e-16 of the offset from the origin (at most 20 sides, see
/// below); an element of 1/7 side loses as much of its volume as a layer of that thickness: 6 * 20 * 7 *
/// 1e-16 per face.
constexpr double kMotionTolerance = 1e-12;

struct Meshes {
    TetMesh fine;
    TetMesh coarse;
};

Meshes any_meshes() {
    const int n_fine = *rc::gen::inRange(1, 7);
    const int n_coarse = *rc::gen::inRange(1, 5);
    const double share = *rc::gen::inRange(0, 20) / 100.0;
    const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1'000'000);
    return {jittered(cube_mesh(n_fine, kSide), n_fine, kSide, share, seed),
            jittered(cube_mesh(n_coarse, kSide), n_coarse, kSide, share, seed + 1)};
}

using Entries = std::map<std::pair<std::uint32_t, std::uint32_t>, double>;  // (fine, coarse)

Entries entries_of(const OverlapMatrix& overlap) {
    Entries entries;
    for (std::uint32_t j = 0; j < overlap.coarse_count; ++j)
        for (auto entry = overlap.row_offsets[j]; entry < overlap.row_offsets[j + 1]; ++entry)
            entries[{overlap.columns[entry], j}] = overlap.volumes_m3[entry];
    return entries;
}

/// Same volumes up to `tolerance` of the smaller element; an absent pair shares nothing.
void expect_same(const Entries& a, const Entries& b, const Meshes& meshes, double tolerance) {
    const auto check = [&](const Entries& these, const Entries& those) {
        for (const auto& [pair, volume] : these) {
            const auto other = those.find(pair);
            const double smaller = std::min(signed_volume_m3(meshes.fine, pair.first),
                                            signed_volume_m3(meshes.coarse, pair.second));
            RC_ASSERT(std::abs(volume - (other == those.end() ? 0.0 : other->second)) <= tolerance * smaller);
        }
    };
    check(a, b);
    check(b, a);
}

std::vector<std::uint32_t> any_permutation(std::size_t size) {
    std::vector<std::uint32_t> order(size);
    for (std::size_t i = 0; i < size; ++i)
        order[i] = static_cast<std::uint32_t>(i);
    std::mt19937_64 bits(*rc::gen::inRange<std::uint64_t>(1, 1'000'000));
    for (std::size_t i = size; i > 1; --i)
        std::swap(order[i - 1], order[bits() % i]);
    return order;
}

TetMesh with_permuted_nodes(const TetMesh& mesh) {
    const auto new_id = any_permutation(mesh.nodes_m.size());
    TetMesh permuted = mesh;
    for (std::size_t i = 0; i < new_id.size(); ++i)
        permuted.nodes_m[new_id[i]] = mesh.nodes_m[i];
    for (Tetrahedron& tet : permuted.tetrahedra)
        for (std::uint32_t& node : tet)
            node = new_id[node];
    return permuted;
}

TetMesh with_permuted_elements(const TetMesh& mesh, const std::vector<std::uint32_t>& old_of_new) {
    TetMesh permuted = mesh;
    for (std::size_t i = 0; i < old_of_new.size(); ++i)
        permuted.tetrahedra[i] = mesh.tetrahedra[old_of_new[i]];
    return permuted;
}

RC_GTEST_PROP(Overlap_of_any_two_meshes_of_a_cube, has_rows_and_columns_that_sum_to_the_volumes, ()) {
    const Meshes meshes = any_meshes();
    std::vector<double> fine(meshes.fine.tetrahedra.size());
    std::vector<double> coarse(meshes.coarse.tetrahedra.size());
    for (const auto& [pair, volume] : entries_of(overlap_volumes(meshes.fine, meshes.coarse, {}))) {
        fine[pair.first] += volume;
        coarse[pair.second] += volume;
    }
    for (std::size_t i = 0; i < fine.size(); ++i)
        RC_ASSERT(std::abs(fine[i] / signed_volume_m3(meshes.fine, i) - 1) <= kSumTolerance);
    for (std::size_t j = 0; j < coarse.size(); ++j)
        RC_ASSERT(std::abs(coarse[j] / signed_volume_m3(meshes.coarse, j) - 1) <= kSumTolerance);
}

RC_GTEST_PROP(Overlap_of_swapped_meshes, is_the_transpose, ()) {
    const Meshes meshes = any_meshes();
    Entries transposed;
    for (const auto& [pair, volume] : entries_of(overlap_volumes(meshes.coarse, meshes.fine, {})))
        transposed[{pair.second, pair.first}] = volume;
    expect_same(entries_of(overlap_volumes(meshes.fine, meshes.coarse, {})), transposed, meshes,
                kSumTolerance);
}

RC_GTEST_PROP(Overlap_of_rigidly_moved_meshes, is_that_of_the_meshes_before, ()) {
    const Meshes meshes = any_meshes();
    const double angle = *rc::gen::inRange(0, 628) / 100.0;
    const auto offset = [] { return *rc::gen::inRange(-100, 100) / 100.0; };  // metres: up to 10 sides
    const Point shift{offset(), offset(), offset()};
    const Entries moved = entries_of(overlap_volumes(rigidly_moved(meshes.fine, angle, shift),
                                                     rigidly_moved(meshes.coarse, angle, shift), {}));
    expect_same(entries_of(overlap_volumes(meshes.fine, meshes.coarse, {})), moved, meshes, kMotionTolerance);
}

RC_GTEST_PROP(Overlap_of_meshes_with_permuted_nodes, is_the_same_to_the_last_bit, ()) {
    const Meshes meshes = any_meshes();
    const Entries permuted =
        entries_of(overlap_volumes(with_permuted_nodes(meshes.fine), with_permuted_nodes(meshes.coarse), {}));
    RC_ASSERT(permuted == entries_of(overlap_volumes(meshes.fine, meshes.coarse, {})));
}

RC_GTEST_PROP(Overlap_of_meshes_with_permuted_elements, is_permuted_alike_to_the_last_bit, ()) {
    const Meshes meshes = any_meshes();
    const auto fine_order = any_permutation(meshes.fine.tetrahedra.size());
    const auto coarse_order = any_permutation(meshes.coarse.tetrahedra.size());
    Entries expected;
    for (const auto& [pair, volume] :
         entries_of(overlap_volumes(with_permuted_elements(meshes.fine, fine_order),
                                    with_permuted_elements(meshes.coarse, coarse_order), {})))
        expected[{fine_order[pair.first], coarse_order[pair.second]}] = volume;
    RC_ASSERT(expected == entries_of(overlap_volumes(meshes.fine, meshes.coarse, {})));
}

}  // namespace
}  // namespace knead::test
