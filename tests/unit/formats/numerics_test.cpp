// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/numerics.h"

#include <gtest/gtest.h>

#include "samples.h"

namespace knead::test {
namespace {

/// An asset with `tetrahedra` copies of one element: the choice looks at nothing but their number and values.
Asset asset_of(std::size_t tetrahedra, double contrast, double poissons_ratio) {
    Asset asset = sample_asset();
    asset.palette = {{1000, 0.1, 1000}, {1000 * contrast, poissons_ratio, 1000}};
    asset.tetrahedra.assign(tetrahedra, asset.tetrahedra[0]);
    asset.palette_index.assign(tetrahedra, 0);
    asset.palette_index.back() = 1;
    return asset;
}

struct Case {
    std::size_t tetrahedra;
    double contrast;
    double poissons_ratio;
    Precision arithmetic;
    Preconditioner preconditioner;
    FactorStorage storage;
};

// One row on each side of every limit, written from the table of the design, not from the constants.
TEST(Choice_of_numerics, Changes_exactly_at_its_limits) {
    using P = Precision;
    using C = Preconditioner;
    using S = FactorStorage;
    const Case cases[] = {
        {1296, 1, 0.3, P::float32, C::factor, S::fixed16},
        {1296, 100, 0.495, P::float32, C::factor, S::fixed16},
        {1296, 100, 0.496, P::float32, C::factor, S::float32},
        {1296, 1e4, 0.3, P::float32, C::factor, S::fixed16},
        {1296, 1.001e4, 0.3, P::mixed, C::factor, S::fixed16},
        {1296, 1e6, 0.3, P::mixed, C::factor, S::fixed16},
        {1296, 1e6, 0.496, P::float64, C::factor, S::float32},
        {1296, 1.001e6, 0.3, P::float64, C::factor, S::float32},
        {1296, 1e9, 0.3, P::float64, C::factor, S::float32},
        {1296, 1.001e9, 0.49, P::float64, C::factor, S::float64},
        {16000, 10, 0.3, P::float32, C::factor, S::fixed16},
        {16001, 10, 0.3, P::float32, C::laplacian, S::fixed16},
        {16001, 10, 0.449, P::float32, C::laplacian, S::fixed16},
        {16001, 10, 0.45, P::float32, C::sparse_inverse, S::fixed16},
        {16001, 1e3, 0.3, P::float32, C::laplacian, S::fixed16},
        {16001, 1.001e3, 0.3, P::float32, C::sparse_inverse, S::fixed16},
        {48000, 1e6, 0.49, P::float64, C::sparse_inverse, S::fixed16},
    };
    for (const Case& c : cases) {
        const Numerics chosen = choose_numerics(asset_of(c.tetrahedra, c.contrast, c.poissons_ratio));
        const std::string what = to_text(chosen);
        EXPECT_EQ(chosen.arithmetic, c.arithmetic) << what;
        EXPECT_EQ(chosen.preconditioner, c.preconditioner) << what;
        EXPECT_EQ(chosen.factor_storage, c.storage) << what;
        EXPECT_DOUBLE_EQ(chosen.contrast, c.contrast) << what;
        EXPECT_EQ(chosen.tetrahedra, c.tetrahedra) << what;
    }
}

/// The column of a stiff tetrahedron on the floor and a soft one beside it, under a tool that both reach.
Asset with_a_stiff_path(double contrast) {
    Asset asset = sample_asset();
    asset.palette = {{1000, 0.3, 1000}, {1000 * contrast, 0.3, 1000}};
    asset.nodes_m.insert(asset.nodes_m.end(), {{0, 0, -1}, {1, 0, -1}});
    asset.tetrahedra = {{0, 1, 2, 8}, {0, 1, 2, 9}};
    asset.palette_index = {0, 1};
    return asset;
}

// Stiff islands need a state in double precision, or all of it; a stiff phase that carries the force from
// tool to support does not.
TEST(Choice_of_numerics, Takes_single_precision_where_the_path_of_the_force_is_stiff) {
    for (const double contrast : {1e5, 1e6, 1e9}) {
        Asset asset = with_a_stiff_path(contrast);
        asset.tools.resize(1);  // bonded
        const Numerics chosen = choose_numerics(asset);
        EXPECT_DOUBLE_EQ(chosen.contrast, contrast);
        EXPECT_EQ(chosen.press_contrast, 1);
        EXPECT_EQ(chosen.arithmetic, Precision::float32);
        EXPECT_EQ(chosen.arithmetic_reason, NumericsReason::stiff_path);
        EXPECT_EQ(chosen.factor_storage, contrast > 1e6 ? FactorStorage::float32 : FactorStorage::fixed16);
        asset.free_node_count = static_cast<std::uint32_t>(asset.nodes_m.size());  // nothing holds it
        EXPECT_EQ(choose_numerics(asset).arithmetic, contrast > 1e6 ? Precision::float64 : Precision::mixed);
    }
}

TEST(Choice_of_numerics, Takes_all_in_double_precision_for_islands_that_are_nearly_incompressible) {
    Asset asset = with_a_stiff_path(1e6);
    asset.free_node_count = static_cast<std::uint32_t>(asset.nodes_m.size());  // nothing holds it
    for (PaletteEntry& entry : asset.palette)
        entry.poissons_ratio = 0.495;
    EXPECT_EQ(choose_numerics(asset).arithmetic, Precision::mixed);
    for (PaletteEntry& entry : asset.palette)
        entry.poissons_ratio = 0.499;
    EXPECT_EQ(choose_numerics(asset).arithmetic, Precision::float64);
}

TEST(Choice_of_numerics, Takes_all_in_double_precision_for_metal_that_nothing_holds) {
    Asset asset = asset_of(1296, 1, 0.3);
    asset.palette[0] = asset.palette[1] = {7800 * 5e3 * 5e3, 0.3, 7800};
    const auto nodes = static_cast<std::uint32_t>(asset.nodes_m.size());
    asset.free_node_count = nodes - 1;
    EXPECT_EQ(choose_numerics(asset).arithmetic, Precision::float32);
    asset.free_node_count = nodes;
    const Numerics chosen = choose_numerics(asset);
    EXPECT_EQ(chosen.arithmetic, Precision::float64);
    EXPECT_STREQ(to_string(chosen.arithmetic_reason), "stiff_and_loose");
    asset.palette[0] = asset.palette[1] = {7800 * 3.9e3 * 3.9e3, 0.3, 7800};
    EXPECT_EQ(choose_numerics(asset).arithmetic, Precision::float32);
}

TEST(Choice_of_numerics, Does_not_look_at_palette_entries_that_no_tetrahedron_uses) {
    Asset asset = asset_of(6, 10, 0.3);
    asset.palette.push_back({1e12, 0.499, 1000});
    const Numerics chosen = choose_numerics(asset);
    EXPECT_DOUBLE_EQ(chosen.contrast, 10);
    EXPECT_DOUBLE_EQ(chosen.max_poissons_ratio, 0.3);
}

TEST(Choice_of_numerics, Says_why_in_one_sentence) {
    EXPECT_EQ(
        to_text(choose_numerics(asset_of(1296, 10, 0.3))),
        "contrast 10, Poisson's ratio up to 0.3, 1296 tetrahedra: solved in float32 (contrast up to 1e+04), "
        "preconditioned by the factor of the rest state (few tetrahedra) kept in fixed16 (contrast up to "
        "1e+06)");
    EXPECT_EQ(to_text(choose_numerics(asset_of(20000, 10, 0.46))),
              "contrast 10, Poisson's ratio up to 0.46, 20000 tetrahedra: solved in float32 (contrast up to "
              "1e+04), "
              "preconditioned by a sparse approximate inverse (nearly incompressible)");
    Asset stiff_path = with_a_stiff_path(1e7);
    stiff_path.tools.resize(1);
    EXPECT_EQ(
        to_text(choose_numerics(stiff_path)),
        "contrast 1e+07 (1 against the path from tool to support), Poisson's ratio up to 0.3, 2 tetrahedra: "
        "solved in float32 (stiff path), preconditioned by the factor of the rest state (few tetrahedra) "
        "kept "
        "in float32 (high contrast)");
    const Numerics hard = choose_numerics(asset_of(20000, 1e10, 0.3));
    EXPECT_STREQ(to_string(hard.arithmetic), "float64");
    EXPECT_STREQ(to_string(hard.factor_storage), "float64");
    EXPECT_STREQ(to_string(hard.preconditioner), "sparse_inverse");
    EXPECT_STREQ(to_string(hard.preconditioner_reason), "high_contrast");
    EXPECT_STREQ(to_string(choose_numerics(asset_of(20000, 10, 0.3)).preconditioner_reason),
                 "many_tetrahedra");
}

}  // namespace
}  // namespace knead::test
