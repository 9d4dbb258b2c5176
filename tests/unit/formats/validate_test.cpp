// SPDX-License-Identifier: Apache-2.0
// Every invariant of every type, broken once.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "samples.h"

namespace knead::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void expect_refused(const Status& status, const std::string& part, const std::string& what) {
    ASSERT_FALSE(status.ok()) << what;
    EXPECT_EQ(status.error().code, ErrorCode::invalid_data) << what;
    EXPECT_NE(status.error().text().find(part), std::string::npos) << what << ": " << status.error().text();
}

template <class T>
struct Break {
    const char* what;
    std::function<void(T&)> change;
    const char* part;  ///< of the message
};

TEST(Validation_of_a_mesh, Refuses_each_broken_invariant_with_its_place) {
    const Break<TetMesh> breaks[] = {
        {"no element", [](TetMesh& m) { m.tetrahedra.clear(); }, "no tetrahedron"},
        {"index", [](TetMesh& m) { m.tetrahedra[2][1] = 8; },
         "1 of 6 tetrahedra name a node beyond the 8 nodes (elements 2)"},
        {"repeated", [](TetMesh& m) { m.tetrahedra[3][1] = m.tetrahedra[3][0]; },
         "name a node twice (elements 3)"},
        {"NaN", [](TetMesh& m) { m.nodes_m[4][2] = kNan; }, "nodes are not finite (nodes 4)"},
        {"infinite", [](TetMesh& m) { m.nodes_m[4][0] = kInfinity; }, "nodes are not finite (nodes 4)"},
        {"unused",
         [](TetMesh& m) {
             m.nodes_m.push_back({1, 1, 1});
         },
         "belong to no tetrahedron (nodes 8)"},
        {"inverted", [](TetMesh& m) { std::swap(m.tetrahedra[5][0], m.tetrahedra[5][1]); },
         "no positive volume (flat or inverted) (elements 5)"},
        {"flat",
         [](TetMesh& m) {
             for (Point& p : m.nodes_m)
                 p[2] = 0;
         },
         "6 of 6 tetrahedra have no positive volume"},
        {"region index", [](TetMesh& m) { m.regions.region_of_tetrahedron[1] = 2; },
         "name no region (elements 1)"},
        {"region length", [](TetMesh& m) { m.regions.region_of_tetrahedron.pop_back(); },
         "5 entries for 6 tetrahedra"},
        {"region name", [](TetMesh& m) { m.regions.names[1] = m.regions.names[0]; }, "appears twice"},
        {"empty name", [](TetMesh& m) { m.regions.names[1] = ""; }, "is empty"},
        {"zero byte", [](TetMesh& m) { m.regions.names[1] = std::string("a\0b", 3); }, "zero byte"},
        {"long name", [](TetMesh& m) { m.regions.names[1] = std::string(40000, 'a'); }, "longer than"},
        {"array length", [](TetMesh& m) { m.cell_arrays[0].values.pop_back(); }, "5 values for 6 tetrahedra"},
        {"array names", [](TetMesh& m) { m.cell_arrays.push_back(m.cell_arrays[0]); }, "appears twice"},
    };
    EXPECT_TRUE(validate(sample_mesh()).ok());
    for (const auto& [what, change, part] : breaks) {
        TetMesh mesh = sample_mesh();
        change(mesh);
        expect_refused(validate(mesh), part, what);
    }
}

TEST(Validation_of_a_material, Refuses_each_broken_invariant_with_its_place) {
    const Break<Material> breaks[] = {
        {"E 0", [](Material& m) { m.youngs_modulus_pa[3] = 0; },
         "youngs_modulus_pa: 1 of 6 values are not finite and > 0 (elements 3)"},
        {"E NaN", [](Material& m) { m.youngs_modulus_pa[3] = kNan; }, "(elements 3)"},
        {"nu 0.5", [](Material& m) { m.poissons_ratio[1] = 0.5; }, "not between -1 and 0.5"},
        {"nu -1", [](Material& m) { m.poissons_ratio[1] = -1; }, "not between -1 and 0.5"},
        {"density", [](Material& m) { m.density_kg_per_m3[0] = -1; }, "density_kg_per_m3"},
        {"length", [](Material& m) { m.poissons_ratio.pop_back(); }, "5 values for 6 tetrahedra"},
        {"bin length", [](Material& m) { m.bin_of_tetrahedron.pop_back(); }, "5 entries for 6 tetrahedra"},
        {"bin value", [](Material& m) { m.bin_of_tetrahedron[0] = 1; }, "differ from the first of their bin"},
        {"bin number", [](Material& m) { m.bin_of_tetrahedron[0] = 4'000'000'000; },
         "bins are numbered from 0"},
    };
    const MaterialObject object = sample_material();
    EXPECT_TRUE(validate(object.material, 6).ok());
    for (const auto& [what, change, part] : breaks) {
        Material material = object.material;
        change(material);
        expect_refused(validate(material, 6), part, what);
    }
}

TEST(Validation_of_a_clustering, Refuses_each_broken_invariant_with_its_place) {
    const Break<Clustering> breaks[] = {
        {"bin length", [](Clustering& c) { c.bin_of_tetrahedron.pop_back(); }, "5 entries for 6 tetrahedra"},
        {"bin index", [](Clustering& c) { c.bin_of_tetrahedron[0] = 2; }, "not below 2"},
        {"unused bin", [](Clustering& c) { c.bin_of_tetrahedron.assign(6, 0); }, "are not used (bins 1)"},
        {"unused cluster", [](Clustering& c) { c.cluster_of_tetrahedron.assign(6, 0); },
         "are not used (clusters 1)"},
        {"order", [](Clustering& c) { std::swap(c.bin_of_cluster[0], c.bin_of_cluster[1]); }, "softer bin"},
        {"disagreement",
         [](Clustering& c) { std::swap(c.cluster_of_tetrahedron[0], c.cluster_of_tetrahedron[1]); },
         "cluster of another bin"},
        {"volume", [](Clustering& c) { c.cluster_volume_m3[1] = 0; }, "volume_m3"},
        {"centre", [](Clustering& c) { c.cluster_barycentre_m[1][1] = kNan; }, "barycentre_m"},
        {"moduli", [](Clustering& c) { c.bin_youngs_modulus_pa[1] = c.bin_youngs_modulus_pa[0]; },
         "not stiffer"},
        {"lengths", [](Clustering& c) { c.bin_poissons_ratio.pop_back(); }, "1 entries for 2 bins"},
    };
    const Clustering valid = sample_clustering().clustering;
    EXPECT_TRUE(validate(valid, 6).ok());
    for (const auto& [what, change, part] : breaks) {
        Clustering clustering = valid;
        change(clustering);
        expect_refused(validate(clustering, 6), part, what);
    }
}

TEST(Validation_of_an_overlap, Refuses_each_broken_invariant_with_its_place) {
    const Break<OverlapMatrix> breaks[] = {
        {"rows", [](OverlapMatrix& m) { m.row_offsets.pop_back(); }, "row_offsets"},
        {"empty rows", [](OverlapMatrix& m) { m.row_offsets.clear(); }, "row_offsets"},
        {"start", [](OverlapMatrix& m) { m.row_offsets[0] = 1; }, "runs from 1 to 3"},
        {"end", [](OverlapMatrix& m) { m.row_offsets[2] = 4; }, "runs from 0 to 4"},
        {"falling", [](OverlapMatrix& m) { m.row_offsets[1] = 9; }, "rows end before they start (rows 1)"},
        {"column", [](OverlapMatrix& m) { m.columns[2] = 3; }, "not below the 3 fine tetrahedra (entries 2)"},
        {"order", [](OverlapMatrix& m) { std::swap(m.columns[1], m.columns[2]); }, "do not increase"},
        {"volume", [](OverlapMatrix& m) { m.volumes_m3[0] = 0; }, "volumes_m3"},
        {"lengths", [](OverlapMatrix& m) { m.volumes_m3.pop_back(); }, "2 volumes for 3 columns"},
    };
    EXPECT_TRUE(validate(sample_overlap()).ok());
    for (const auto& [what, change, part] : breaks) {
        OverlapMatrix matrix = sample_overlap();
        change(matrix);
        expect_refused(validate(matrix), part, what);
    }
}

TEST(Validation_of_an_asset, Refuses_each_broken_invariant_with_its_place) {
    const Break<Asset> breaks[] = {
        {"mesh", [](Asset& a) { a.nodes_m[0][0] = kNan; }, "/knead/asset/mesh/nodes_m"},
        {"free nodes", [](Asset& a) { a.free_node_count = 9; }, "9 free nodes of 8"},
        {"held element", [](Asset& a) { a.free_node_count = 0; }, "tetrahedra have no free node"},
        {"palette", [](Asset& a) { a.palette.clear(); }, "the palette is empty"},
        {"modulus", [](Asset& a) { a.palette[1].youngs_modulus_pa = 0; }, "palette/youngs_modulus_pa"},
        {"ratio", [](Asset& a) { a.palette[1].poissons_ratio = 0.5; }, "palette/poissons_ratio"},
        {"density", [](Asset& a) { a.palette[1].density_kg_per_m3 = kNan; }, "palette/density_kg_per_m3"},
        {"index", [](Asset& a) { a.palette_index[1] = 2; }, "name no palette entry (elements 1)"},
        {"index length", [](Asset& a) { a.palette_index.pop_back(); }, "5 entries for 6 tetrahedra"},
        {"tool name", [](Asset& a) { a.tools[1].name = "press"; }, "appears twice"},
        {"bonded", [](Asset& a) { a.tools[0].nodes.clear(); }, "has no node"},
        {"tool node", [](Asset& a) { a.tools[0].nodes[2] = 8; }, "not free"},
        {"tool order", [](Asset& a) { std::swap(a.tools[0].nodes[0], a.tools[0].nodes[1]); },
         "increasing order"},
        {"radius", [](Asset& a) { a.tools[1].radius_m = 0; }, "radius"},
        {"capsule radius", [](Asset& a) { a.tools[2].radius_m = -1; }, "finger/radius_m"},
        {"half length", [](Asset& a) { a.tools[2].half_length_m = 0; }, "finger/half_length_m"},
        {"endless", [](Asset& a) { a.tools[2].half_length_m = kInfinity; }, "finger/half_length_m"},
        {"no friction", [](Asset& a) { a.tools[2].friction_coefficient = 0; }, "finger/friction_coefficient"},
        {"friction", [](Asset& a) { a.tools[2].friction_coefficient = 10.5; }, "finger/friction_coefficient"},
        {"nan", [](Asset& a) { a.tools[2].friction_coefficient = kNan; }, "finger/friction_coefficient"},
        {"shape", [](Asset& a) { a.tools[2].shape = static_cast<ToolShape>(3); }, "none of plate, sphere"},
        {"contact", [](Asset& a) { a.tools[2].contact = static_cast<ToolContact>(4); }, "none of bonded"},
        {"half", [](Asset& a) { a.tools[0].half_extents_m[1] = 0; }, "half extents"},
        {"position", [](Asset& a) { a.tools[0].rest_position_m[1] = kNan; }, "rest position"},
        {"quaternion", [](Asset& a) { a.tools[0].rest_orientation_wxyz[0] = 2; }, "unit quaternion"},
        {"gravity", [](Asset& a) { a.gravity_m_per_s2[0] = kNan; }, "gravity"},
        {"damping", [](Asset& a) { a.damping_per_s = -1; }, "damping"},
        {"weights", [](Asset& a) { a.embedding.weights.pop_back(); }, "2 rows of weights for 3 vertices"},
        {"embedded in", [](Asset& a) { a.embedding.tetrahedron[1] = 6; }, "no tetrahedron (vertices 1)"},
        {"sum", [](Asset& a) { a.embedding.weights[2][0] += 2e-5F; }, "embedding/weights: 1 of 3"},
        {"size",
         [](Asset& a) {
             a.embedding.weights[2] = {17, -16, 0, 0};
         },
         "larger than 16 (vertices 2)"},
        {"finite", [](Asset& a) { a.embedding.weights[0][3] = float(kNan); }, "embedding/weights: 1 of 3"},
        {"still", [](Asset& a) { a.embedding.still_vertices_m[0][2] = kInfinity; }, "still_vertices_m"},
        {"vertex", [](Asset& a) { a.embedding.triangles[1][2] = 4; }, "embedding/triangles: 1 of 2"},
        {"corner", [](Asset& a) { a.embedding.triangles[1][2] = 0; }, "name a vertex twice"},
        {"no triangle", [](Asset& a) { a.embedding.triangles.clear(); }, "vertices without a triangle"},
        {"surface", [](Asset& a) { a.surface.triangles[0][0] = 8; }, "triangles"},
    };
    EXPECT_TRUE(validate(sample_asset()).ok());
    for (const auto& [what, change, part] : breaks) {
        Asset asset = sample_asset();
        change(asset);
        expect_refused(validate(asset), part, what);
    }
}

}  // namespace
}  // namespace knead::test
