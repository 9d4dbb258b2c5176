// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <numeric>

#include "same.h"
#include "samples.h"

namespace knead::test {
namespace {

/// A cube of up to 3^3 cells with moved nodes: far less than what would turn a tetrahedron over.
TetMesh any_mesh() {
    TetMesh mesh = kuhn_cube(*rc::gen::inRange<std::uint32_t>(1, 4), *rc::gen::element(0.01, 1.0, 300.0));
    const double cell = mesh.nodes_m[1][0];
    for (Point& p : mesh.nodes_m)
        for (double& x : p)
            x += cell * 0.01 * (*rc::gen::inRange(-1000, 1000) / 1000.0);
    const std::size_t count = mesh.tetrahedra.size();
    const auto regions = *rc::gen::inRange<std::uint32_t>(0, 4);
    for (std::uint32_t i = 0; i < regions; ++i)
        mesh.regions.names.push_back("region " + std::to_string(i));
    if (regions > 0)
        mesh.regions.region_of_tetrahedron = *rc::gen::container<std::vector<std::uint32_t>>(
            count, rc::gen::inRange<std::uint32_t>(0, regions));
    const auto arrays = *rc::gen::inRange(0, 12);
    for (int i = 0; i < arrays; ++i)
        mesh.cell_arrays.push_back({"array/" + std::to_string(i), *rc::gen::container<std::vector<double>>(
                                                                      count, rc::gen::arbitrary<double>())});
    return mesh;
}

Material any_material(std::size_t count) {
    Material material;
    for (std::size_t i = 0; i < count; ++i) {
        material.youngs_modulus_pa.push_back(*rc::gen::inRange(1, 1'000'000) / 7.0);
        material.poissons_ratio.push_back(*rc::gen::inRange(-999, 500) / 1000.0);
        material.density_kg_per_m3.push_back(*rc::gen::inRange(1, 10'000) / 3.0);
    }
    if (*rc::gen::arbitrary<bool>()) {
        material.bin_of_tetrahedron.resize(count);
        std::iota(material.bin_of_tetrahedron.begin(), material.bin_of_tetrahedron.end(), 0U);
    }
    return material;
}

Clustering any_clustering(std::size_t count) {
    Clustering c;
    const auto bins = *rc::gen::inRange<std::uint32_t>(1, 5);
    for (std::uint32_t i = 0; i < count; ++i)
        c.bin_of_tetrahedron.push_back(i % bins);
    c.cluster_of_tetrahedron = c.bin_of_tetrahedron;
    for (std::uint32_t bin = 0; bin < bins; ++bin) {
        c.bin_youngs_modulus_pa.push_back(1000.0 * bin + *rc::gen::inRange(1, 999));
        c.bin_poissons_ratio.push_back(*rc::gen::inRange(-99, 50) / 100.0);
        c.bin_density_kg_per_m3.push_back(*rc::gen::inRange(1, 5000));
        c.bin_of_cluster.push_back(bin);
        c.cluster_barycentre_m.push_back({*rc::gen::inRange(-9, 9) / 7.0, 0.5, -1.0});
        c.cluster_volume_m3.push_back(*rc::gen::inRange(1, 100) * 1e-7);
    }
    return c;
}

OverlapMatrix any_overlap() {
    OverlapMatrix matrix;
    matrix.coarse_count = *rc::gen::inRange<std::uint32_t>(0, 50);
    matrix.fine_count = *rc::gen::inRange<std::uint32_t>(1, 60);
    matrix.row_offsets.push_back(0);
    for (std::uint32_t row = 0; row < matrix.coarse_count; ++row) {
        for (std::uint32_t column = 0; column < matrix.fine_count; ++column)
            if (*rc::gen::inRange(0, 4) == 0) {
                matrix.columns.push_back(column);
                matrix.volumes_m3.push_back(*rc::gen::inRange(1, 1000) / 3e9);
            }
        matrix.row_offsets.push_back(matrix.columns.size());
    }
    return matrix;
}

ToolSet any_tool(std::uint32_t free_nodes, int number) {
    ToolSet tool;
    tool.name = "tool " + std::to_string(number);
    tool.shape = *rc::gen::element(ToolShape::plate, ToolShape::sphere, ToolShape::capsule);
    tool.contact = *rc::gen::element(ToolContact::bonded, ToolContact::sticking, ToolContact::frictionless,
                                     ToolContact::coulomb);
    if (tool.shape == ToolShape::capsule) tool.half_length_m = *rc::gen::inRange(1, 100) / 77.0;
    if (tool.contact == ToolContact::coulomb) tool.friction_coefficient = *rc::gen::inRange(1, 101) / 10.0;
    if (tool.shape != ToolShape::plate)
        tool.radius_m = *rc::gen::inRange(1, 100) / 777.0;
    else if (*rc::gen::arbitrary<bool>())
        tool.half_extents_m = {*rc::gen::inRange(1, 100) / 7.0, 0.25};
    tool.rest_position_m = {*rc::gen::inRange(-100, 100) / 3.0, 0, 1};
    tool.rest_orientation_wxyz = {0.6, 0, 0.8, 0};
    for (std::uint32_t node = 0; node < free_nodes; ++node)
        if (*rc::gen::inRange(0, 3) == 0) tool.nodes.push_back(node);
    if (tool.nodes.empty() && tool.contact == ToolContact::bonded) tool.nodes.push_back(free_nodes - 1);
    return tool;
}

Asset any_asset() {
    const TetMesh mesh = any_mesh();
    Asset asset;
    asset.name = *rc::gen::element<std::string>("", "steak", "name with \xc3\xbc");
    asset.level = *rc::gen::element<std::string>("", "k3");
    asset.nodes_m = mesh.nodes_m;
    asset.tetrahedra = mesh.tetrahedra;
    asset.free_node_count = static_cast<std::uint32_t>(mesh.nodes_m.size());
    const auto palette = *rc::gen::element<std::uint32_t>(1, 2, 256, 257, 65536, 65537);
    for (std::uint32_t i = 0; i < palette; ++i)
        asset.palette.push_back({1.0 + i, 0.3, 1000});
    for (std::size_t i = 0; i < mesh.tetrahedra.size(); ++i)
        asset.palette_index.push_back(i == 0 ? palette - 1 : *rc::gen::inRange<std::uint32_t>(0, palette));
    const int tools = *rc::gen::inRange(0, 12);
    for (int i = 0; i < tools; ++i)
        asset.tools.push_back(any_tool(asset.free_node_count, i));
    if (*rc::gen::arbitrary<bool>()) asset.gravity_m_per_s2 = {0, -9.81, 0.1};
    if (*rc::gen::arbitrary<bool>()) asset.damping_per_s = 0.1;
    if (*rc::gen::arbitrary<bool>()) asset.surface.triangles = {{0, 1, 2}, {1, 2, 3}};
    if (*rc::gen::arbitrary<bool>()) {
        asset.embedding.tetrahedron.assign(*rc::gen::inRange(0, 99), 1);
        asset.embedding.weights.assign(asset.embedding.tetrahedron.size(), {0.125F, -0.5F, 1.375F, 0});
        asset.embedding.still_vertices_m.assign(*rc::gen::inRange(3, 9), {0.1, 1e9, -2});
        asset.embedding.triangles = {{0, 1, 2}, {1, 2, 0}};
    }
    if (*rc::gen::arbitrary<bool>())
        asset.requests = {{"/knead/asset", "", 0}, {"/knead/asset/tools", "tool", 4}};
    return asset;
}

/// Few cases of each: one case writes files.
template <class Body>
void for_some(Body body) {
    rc::detail::TestParams params = rc::detail::configuration().testParams;
    params.maxSuccess = 25;
    const auto result = rc::detail::checkTestable(body, rc::detail::TestMetadata{}, params);
    if (result.template is<rc::detail::SuccessResult>()) return;
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    FAIL() << text.str();
}

template <class T>
T value_of(Result<T> result) {
    if (!result.ok()) RC_FAIL(result.error().text());
    return std::move(result).value();
}

const Folder& folder() {
    static const Folder instance;
    return instance;
}

/// Writes twice, reads back: the same data, and the same bytes.
template <class T, class Write, class Read>
void check_round_trip(const T& object, Write write, Read read) {
    const auto first = folder() / "first.hdf", second = folder() / "second.hdf";
    const Provenance provenance = sample_provenance();
    value_of(write(first, object, provenance));
    value_of(write(second, object, provenance));
    RC_ASSERT(same(value_of(read(first, ReadLimits{})), object));
    RC_ASSERT(bytes_of(first) == bytes_of(second));
    RC_ASSERT(same(value_of(read_header(first)).provenance, provenance));
}

TEST(Round_trip, Of_any_mesh_is_the_identity) {
    for_some([] { check_round_trip(any_mesh(), write_tet_mesh, read_tet_mesh); });
}

TEST(Round_trip, Of_any_material_is_the_identity) {
    for_some([] {
        MaterialObject object{any_mesh(), {}};
        object.material = any_material(object.mesh.tetrahedra.size());
        check_round_trip(object, write_material, read_material);
    });
}

TEST(Round_trip, Of_any_clustering_is_the_identity) {
    for_some([] {
        ClusteredObject object{any_mesh(), {}, {}};
        object.material = any_material(object.mesh.tetrahedra.size());
        object.clustering = any_clustering(object.mesh.tetrahedra.size());
        check_round_trip(object, write_clustering, read_clustering);
    });
}

TEST(Round_trip, Of_any_overlap_is_the_identity) {
    for_some([] { check_round_trip(any_overlap(), write_overlap, read_overlap); });
}

TEST(Round_trip, Of_any_asset_is_the_identity) {
    for_some([] { check_round_trip(any_asset(), write_asset, read_asset); });
}

TEST(Content_hash, Changes_with_the_data_and_not_with_the_provenance) {
    const auto hash_of = [](const TetMesh& mesh, const Provenance& provenance) {
        const auto file = folder() / "hash.hdf";
        EXPECT_TRUE(write_tet_mesh(file, mesh, provenance).ok());
        return read_header(file).value().content_hash;
    };
    TetMesh mesh = sample_mesh();
    Provenance provenance = sample_provenance();
    const std::string hash = hash_of(mesh, provenance);
    provenance.tool = "another";
    EXPECT_EQ(hash_of(mesh, provenance), hash);
    mesh.nodes_m[0][0] -= 1e-15;
    EXPECT_NE(hash_of(mesh, provenance), hash);
    mesh = sample_mesh();
    mesh.cell_arrays[0].name += "x";
    EXPECT_NE(hash_of(mesh, provenance), hash);
}

TEST(Reader_of_an_earlier_kind, Reads_the_part_of_a_later_one) {
    const auto file = folder() / "later.hdf";
    const ClusteredObject object = sample_clustering();
    ASSERT_TRUE(write_clustering(file, object, {}).ok());
    EXPECT_TRUE(same(read_tet_mesh(file).value(), object.mesh));
    EXPECT_TRUE(same(read_material(file).value(), MaterialObject{object.mesh, object.material}));
}

// "1,296 tetrahedra without accelerator fit in well under 64 kB" (design of the format).
TEST(Asset_file, Of_1296_tetrahedra_stays_far_below_64_kB) {
    constexpr std::uintmax_t kMostBytes = 24'000;
    const auto file = folder() / "small.hdf";
    Asset asset = sample_asset(6);
    asset.tools.resize(1);
    asset.surface.triangles.clear();
    asset.tools[0].nodes.clear();
    for (std::uint32_t i = 294; i < 343; ++i)
        asset.tools[0].nodes.push_back(i);
    ASSERT_EQ(asset.tetrahedra.size(), 1296U);
    ASSERT_TRUE(write_asset(file, asset, sample_provenance()).ok());
    EXPECT_LT(std::filesystem::file_size(file), kMostBytes);
}

TEST(Asset_file, Without_options_has_no_group_for_them) {
    Asset asset = sample_asset();
    asset.tools.clear();
    asset.gravity_m_per_s2 = {};
    asset.damping_per_s = 0;
    asset.surface.triangles.clear();
    asset.requests.clear();
    const auto full = folder() / "full.hdf", lean = folder() / "lean.hdf";
    ASSERT_TRUE(write_asset(full, sample_asset(), {}).ok());
    ASSERT_TRUE(write_asset(lean, asset, {}).ok());
    for (const char* group : {"tools", "gravity", "damping", "surface", "requests"}) {
        const auto holds = [&](const std::filesystem::path& file) {
            const std::vector<char> bytes = bytes_of(file);
            return std::string_view(bytes.data(), bytes.size()).find(group) != std::string_view::npos;
        };
        EXPECT_TRUE(holds(full)) << group;
        EXPECT_FALSE(holds(lean)) << group;
    }
}

}  // namespace
}  // namespace knead::test
