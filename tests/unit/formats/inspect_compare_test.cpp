// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "knead/formats/compare.h"
#include "knead/formats/inspect.h"
#include "knead/formats/read_stored.h"
#include "samples.h"

namespace knead::test {
namespace {

TEST(Inspection, Lists_every_dataset_with_its_bytes_and_sums_the_groups) {
    const Folder folder;
    ASSERT_TRUE(write_asset(folder / "a.hdf", sample_asset(4), sample_provenance()).ok());
    const FileInfo info = inspect_file(folder / "a.hdf").value();
    EXPECT_EQ(info.file_bytes, std::filesystem::file_size(folder / "a.hdf"));
    const auto node = [&](const std::string& path) {
        return *std::find_if(info.nodes.begin(), info.nodes.end(),
                             [&](const NodeInfo& n) { return n.path == path; });
    };
    EXPECT_EQ(node("/knead/asset/mesh/nodes_m").type, "float64");
    EXPECT_EQ(node("/knead/asset/mesh/nodes_m").extents, (std::vector<std::uint64_t>{125, 3}));
    EXPECT_EQ(node("/knead/asset/mesh/nodes_m").units, "m");
    EXPECT_EQ(node("/knead").bytes_on_disk + info.other_bytes, info.file_bytes);
    EXPECT_GT(node("/knead/asset").bytes_on_disk, node("/knead/asset/mesh").bytes_on_disk);
    EXPECT_GT(
        node("/knead/asset/mesh").bytes_on_disk,
        node("/knead/asset/mesh/nodes_m").bytes_on_disk + node("/knead/asset/mesh/tetrahedra").bytes_on_disk);
}

TEST(Comparison, Of_a_file_with_itself_finds_nothing) {
    const Folder folder;
    ASSERT_TRUE(write_clustering(folder / "a.hdf", sample_clustering(), {}).ok());
    ASSERT_TRUE(write_clustering(folder / "b.hdf", sample_clustering(), sample_provenance()).ok());
    EXPECT_TRUE(compare_files(folder / "a.hdf", folder / "b.hdf").value().empty());
}

TEST(Comparison, Says_where_files_differ_and_by_how_much) {
    const Folder folder;
    MaterialObject a = sample_material(), b = sample_material();
    b.mesh.nodes_m[7][1] += 0.25;
    b.mesh.nodes_m[7][2] += 0.125;
    b.material.bin_of_tetrahedron.clear();
    ASSERT_TRUE(write_material(folder / "a.hdf", a, {}).ok());
    ASSERT_TRUE(write_material(folder / "b.hdf", b, {}).ok());
    const auto found = compare_files(folder / "a.hdf", folder / "b.hdf").value();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0].path, "/knead/material/bin_of_tetrahedron");
    EXPECT_EQ(found[0].message, "only in the first file");
    EXPECT_EQ(found[1].path, "/knead/mesh/nodes_m");
    EXPECT_EQ(found[1].count, 2U);
    EXPECT_DOUBLE_EQ(found[1].largest_absolute, 0.25);
    EXPECT_NE(found[1].message.find("2 of 24 values differ, first at [7, 1]: 0.1 and 0.35"),
              std::string::npos)
        << found[1].message;
}

TEST(Comparison, Accepts_differences_inside_the_tolerance_of_a_dataset) {
    const Folder folder;
    TetMesh mesh = sample_mesh();
    ASSERT_TRUE(write_tet_mesh(folder / "a.hdf", mesh, {}).ok());
    mesh.nodes_m[7][1] += 1e-6;
    ASSERT_TRUE(write_tet_mesh(folder / "b.hdf", mesh, {}).ok());
    const auto differences = [&](const CompareOptions& options) {
        return compare_files(folder / "a.hdf", folder / "b.hdf", options).value().size();
    };
    EXPECT_EQ(differences({}), 1U);
    EXPECT_EQ(differences({{2e-6, 0}, {}}), 0U);
    EXPECT_EQ(differences({{0.5e-6, 0}, {}}), 1U);
    EXPECT_EQ(differences({{0, 2e-5}, {}}), 0U);
    EXPECT_EQ(differences({{}, {{"nodes_m", {2e-6, 0}}}}), 0U);
    EXPECT_EQ(differences({{2e-6, 0}, {{"/knead/mesh/nodes_m", {}}}}), 1U);
}

TEST(Comparison, With_a_tolerance_for_an_unknown_dataset_gives_invalid_argument) {
    const Folder folder;
    ASSERT_TRUE(write_tet_mesh(folder / "a.hdf", sample_mesh(), {}).ok());
    const auto code = [&](const CompareOptions& options) {
        return compare_files(folder / "a.hdf", folder / "a.hdf", options).error().code;
    };
    EXPECT_EQ(code({{}, {{"nodes", {1, 0}}}}), ErrorCode::invalid_argument);
    EXPECT_EQ(code({{-1, 0}, {}}), ErrorCode::invalid_argument);
}

template <class T>
void expect_header_hash(const std::filesystem::path& file) {
    const Result<Stored<T>> stored = read_stored<T>(file);
    ASSERT_TRUE(stored.ok()) << stored.error().text();
    EXPECT_EQ(stored.value().content_hash, read_header(file).value().content_hash);
}

TEST(Stored_value, Comes_with_the_content_hash_of_the_header) {
    const Folder folder;
    ASSERT_TRUE(write_clustering(folder / "a.hdf", sample_clustering(), {}).ok());
    expect_header_hash<TetMesh>(folder / "a.hdf");
    expect_header_hash<MaterialObject>(folder / "a.hdf");
    expect_header_hash<ClusteredObject>(folder / "a.hdf");
    ASSERT_TRUE(write_overlap(folder / "a.hdf", sample_overlap(), {}).ok());
    expect_header_hash<OverlapMatrix>(folder / "a.hdf");
    EXPECT_EQ(read_stored<TetMesh>(folder / "a.hdf").error().code, ErrorCode::wrong_kind);
    ASSERT_TRUE(write_asset(folder / "a.hdf", sample_asset(), {}).ok());
    expect_header_hash<Asset>(folder / "a.hdf");
}

TEST(Validation_of_a_file, Gives_the_kind_of_each) {
    const Folder folder;
    ASSERT_TRUE(write_tet_mesh(folder / "0", sample_mesh(), {}).ok());
    ASSERT_TRUE(write_material(folder / "1", sample_material(), {}).ok());
    ASSERT_TRUE(write_clustering(folder / "2", sample_clustering(), {}).ok());
    ASSERT_TRUE(write_overlap(folder / "3", sample_overlap(), {}).ok());
    ASSERT_TRUE(write_asset(folder / "4", sample_asset(), {}).ok());
    for (int kind = 0; kind < 5; ++kind)
        EXPECT_EQ(static_cast<int>(validate_file(folder / std::to_string(kind)).value()), kind);
}

}  // namespace
}  // namespace knead::test
