// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/geometry.h"
#include "mesh/repair.h"
#include "mesh/size_search.h"
#include "quality/mesh_quality.h"
#include "unit/mesh/samples.h"

namespace knead::tools {
namespace {

/// Two tetrahedra on the two sides of a triangle, numbered from 100 (nodes) and 200 (tetrahedra).
RawMesh two_tetrahedra() {
    RawMesh mesh;
    mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.tetrahedra = {{0, 1, 2, 3}, {0, 2, 1, 4}};
    for (int i = 0; i < 5; ++i)
        mesh.node_numbers.push_back(100 + i);
    mesh.tetrahedron_numbers = {200, 201};
    mesh.numbering = "numbered as drawn";
    return mesh;
}

bool told(const Notes& notes, const std::string& text) {
    for (const Note& note : notes)
        if (note.text.find(text) != std::string::npos) return true;
    return false;
}

RepairOptions merging() {
    return {.metres_per_unit = 1, .merge_duplicate_nodes = true, .repair_orientation = false};
}
RepairOptions turning() {
    return {.metres_per_unit = 1, .merge_duplicate_nodes = false, .repair_orientation = true};
}

TEST(Repair, Leaves_a_good_mesh_as_it_is_in_metres) {
    const RepairedMesh result = to_tet_mesh(two_tetrahedra(), {.metres_per_unit = 0.001});
    EXPECT_TRUE(result.notes.empty());
    EXPECT_EQ(result.mesh.nodes_m[3], (Point{0, 0, 0.001}));
    EXPECT_EQ(result.mesh.tetrahedra, (std::vector<Tetrahedron>{{0, 1, 2, 3}, {0, 2, 1, 4}}));
    EXPECT_TRUE(validate(result.mesh).ok());
}

TEST(Repair, Turns_all_inverted_tetrahedra_round_and_tells) {
    RawMesh raw = two_tetrahedra();
    for (auto& t : raw.tetrahedra)
        std::swap(t[0], t[1]);
    const RepairedMesh result = to_tet_mesh(raw, {});
    EXPECT_TRUE(told(result.notes, "all 2 tetrahedra were inverted"));
    EXPECT_TRUE(validate(result.mesh).ok());
}

TEST(Repair, Refuses_some_inverted_tetrahedra_unless_asked_to_repair) {
    RawMesh raw = two_tetrahedra();
    std::swap(raw.tetrahedra[1][0], raw.tetrahedra[1][1]);
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {}), bad_input,
                         "1 of 2 tetrahedra are inverted (201; numbered as drawn)");
    const RepairedMesh result = to_tet_mesh(raw, turning());
    EXPECT_TRUE(told(result.notes, "1 of 2 tetrahedra were inverted (201"));
    EXPECT_TRUE(validate(result.mesh).ok());
}

TEST(Repair, Refuses_flat_tetrahedra_of_any_size) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        RawMesh raw = two_tetrahedra();
        raw.nodes[3] = {0.3, 0.3, 1e-10};
        KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {.metres_per_unit = scale}), bad_input,
                             "1 of 2 tetrahedra have no volume (200");
        raw.nodes[3] = {0.3, 0.3, 1e-6};
        EXPECT_NO_THROW((void)to_tet_mesh(raw, {.metres_per_unit = scale}));
    }
}

TEST(Repair, Refuses_repeated_nodes_missing_nodes_and_repeated_tetrahedra) {
    RawMesh raw = two_tetrahedra();
    raw.tetrahedra[0][3] = 0;
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {}), bad_input, "1 of 2 tetrahedra have the same node twice (200");
    raw.tetrahedra[0][3] = 5;
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {}), bad_input, "name a node that does not exist (200");
    raw.tetrahedra[0][3] = -1;
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {}), bad_input, "name a node that does not exist (200");
    raw = two_tetrahedra();
    raw.tetrahedra.push_back({1, 2, 0, 3});
    raw.tetrahedron_numbers.push_back(202);
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {}), bad_input, "1 of 3 tetrahedra repeat an earlier one (202");
}

TEST(Repair, Refuses_coordinates_that_are_not_finite) {
    RawMesh raw = two_tetrahedra();
    raw.nodes[2][1] = NAN;
    raw.nodes[4][0] = INFINITY;
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {}), bad_input,
                         "2 of 5 nodes have a coordinate that is not finite (102, 104");
    raw = two_tetrahedra();
    raw.nodes[2][1] = 1e308;
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {.metres_per_unit = 1e3}), bad_input, "not finite");
}

TEST(Repair, Refuses_coincident_nodes_unless_asked_to_join_them) {
    RawMesh raw = two_tetrahedra();
    raw.nodes.push_back({1, 0, 0});
    raw.node_numbers.push_back(105);
    raw.tetrahedra[1] = {0, 2, 5, 4};
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {}), bad_input,
                         "1 of 6 nodes lie exactly where an earlier node lies (105");
    const RepairedMesh result = to_tet_mesh(raw, merging());
    EXPECT_TRUE(told(result.notes, "nodes joined"));
    EXPECT_EQ(result.mesh.nodes_m.size(), 5U);
    EXPECT_EQ(result.mesh.tetrahedra[1], (Tetrahedron{0, 2, 1, 4}));
}

TEST(Repair, Drops_unused_nodes_even_coincident_or_broken_ones_and_tells) {
    RawMesh raw = two_tetrahedra();
    raw.nodes.insert(raw.nodes.begin(), {{NAN, 0, 0}, {0, 0, 1}});
    raw.node_numbers.insert(raw.node_numbers.begin(), {98, 99});
    for (auto& t : raw.tetrahedra)
        for (auto& node : t)
            node += 2;
    const RepairedMesh result = to_tet_mesh(raw, {});
    EXPECT_TRUE(told(result.notes, "2 of 7 nodes dropped: no tetrahedron uses them (98, 99"));
    EXPECT_EQ(result.mesh.nodes_m, to_tet_mesh(two_tetrahedra(), {}).mesh.nodes_m);
    EXPECT_EQ(result.mesh.tetrahedra, to_tet_mesh(two_tetrahedra(), {}).mesh.tetrahedra);
}

TEST(Repair, Of_a_mesh_in_another_order_gives_the_same_mesh_in_that_order) {
    const TetMesh cubes = make_cubes({3, 2, 4}, {0.3, 0.2, 0.4});
    const std::size_t nodes = cubes.nodes_m.size();
    const std::size_t count = cubes.tetrahedra.size();
    const auto node_of = [&](std::size_t i) { return (i * 7 + 3) % nodes; };  // 60 nodes, coprime to 7
    const auto tetrahedron_of = [&](std::size_t t) { return (t * 5 + 11) % count; };  // 144, coprime to 5
    RawMesh raw;
    raw.nodes.resize(nodes);
    for (std::size_t i = 0; i < nodes; ++i)
        raw.nodes[node_of(i)] = cubes.nodes_m[i];
    raw.tetrahedra.resize(count);
    raw.cell_arrays = {{"was", std::vector<double>(count)}};
    for (std::size_t t = 0; t < count; ++t) {
        for (int i = 0; i < 4; ++i)
            raw.tetrahedra[tetrahedron_of(t)][i] = static_cast<std::int64_t>(node_of(cubes.tetrahedra[t][i]));
        raw.cell_arrays[0].values[tetrahedron_of(t)] = static_cast<double>(t);
    }
    raw.node_numbers.resize(nodes);
    raw.tetrahedron_numbers.resize(count);
    const TetMesh mesh = to_tet_mesh(raw, {}).mesh;
    for (std::size_t t = 0; t < count; ++t) {
        const auto was = static_cast<std::size_t>(mesh.cell_arrays[0].values[t]);
        for (int i = 0; i < 4; ++i)
            EXPECT_EQ(mesh.nodes_m[mesh.tetrahedra[t][i]], cubes.nodes_m[cubes.tetrahedra[was][i]]);
    }
}

TEST(Repair, Tells_other_cells_and_refuses_a_mesh_without_tetrahedra) {
    RawMesh raw = two_tetrahedra();
    raw.other_cells = {{"hexahedra", 3}, {"lines", 2}};
    EXPECT_TRUE(told(to_tet_mesh(raw, {}).notes, "3 hexahedra, 2 lines"));
    raw.tetrahedra.clear();
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(raw, {}), bad_input, "no linear tetrahedra, only 3 hexahedra, 2 lines");
    KNEAD_EXPECT_REFUSAL(to_tet_mesh(RawMesh{}, {}), bad_input, "no tetrahedra");
}

TEST(Quality, Counts_bodies_and_names_slivers_and_unlikely_sizes) {
    RawMesh raw = two_tetrahedra();
    for (const Point& p : std::vector<Point>{{50, 0, 0}, {51, 0, 0}, {50, 1, 0}, {50.3, 0.3, 0.01}})
        raw.nodes.push_back(p);
    raw.node_numbers.resize(9);
    raw.tetrahedra.push_back({5, 6, 7, 8});
    raw.tetrahedron_numbers.push_back(202);
    const TetMesh mesh = to_tet_mesh(raw, {}).mesh;
    const MeshQuality quality = measure(mesh);
    EXPECT_EQ(quality.bodies, 2U);
    EXPECT_EQ(quality.slivers, (std::vector<std::uint32_t>{2}));
    EXPECT_DOUBLE_EQ(quality.volume_m3, 2.0 / 6 + 0.01 / 6);
    const Notes notes = remarks(mesh, quality);
    EXPECT_TRUE(told(notes, "51 m across: this looks like millimetres called metres"));
    EXPECT_TRUE(told(notes, "2 bodies"));
    EXPECT_TRUE(told(notes, "1 of 3 tetrahedra are slivers (2;"));
    const TetMesh small = to_tet_mesh(two_tetrahedra(), {}).mesh;
    EXPECT_TRUE(remarks(small, measure(small)).empty());
}

TEST(SizeSearch, Finds_a_count_within_tolerance_of_a_third_power_with_jumps) {
    for (const std::size_t wanted : {40U, 1207U, 2894U, 100000U}) {
        int calls = 0;
        const auto found = search_edge_length(wanted, 1, [&](double& length) {
            ++calls;
            const double smooth = 3 / (length * length * length) + 2 / (length * length);
            return static_cast<std::size_t>(smooth * (1 + 0.02 * std::sin(200 * length)));
        });
        EXPECT_TRUE(found.within_tolerance) << wanted;
        EXPECT_NEAR(static_cast<double>(found.count), static_cast<double>(wanted),
                    kCountTolerance * static_cast<double>(wanted));
        EXPECT_EQ(found.meshings, calls);
        EXPECT_LE(calls, kMaxMeshings);
    }
}

TEST(SizeSearch, Ends_with_the_nearest_when_no_length_gives_the_count) {
    int calls = 0;
    const auto found = search_edge_length(30, 1, [&](double& length) {
        ++calls;
        return length < 0.7 ? std::size_t{48} : std::size_t{24};
    });
    EXPECT_FALSE(found.within_tolerance);
    EXPECT_EQ(found.count, 24U);
    EXPECT_LE(calls, kMaxMeshings);
}

}  // namespace
}  // namespace knead::tools
