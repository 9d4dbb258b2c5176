// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead {

/// One entry of the asset's palette of materials.
struct PaletteEntry {
    double youngs_modulus_pa = 0;
    double poissons_ratio = 0;
    double density_kg_per_m3 = 0;
};

enum class ToolShape : std::uint8_t {
    plate = 0,    ///< rectangle of half_extents_m in the tool's x-y plane; its face looks along -z
    sphere = 1,   ///< ball of radius_m about the tool's origin
    capsule = 2,  ///< ball of radius_m swept along the tool's z axis from -half_length_m to +half_length_m
};

enum class ToolContact : std::uint8_t {
    bonded = 0,        ///< the tool's nodes follow its pose from the start (the paper's press)
    sticking = 1,      ///< unilateral: touches and leaves; no sliding while it touches
    frictionless = 2,  ///< unilateral: touches and leaves; slides freely
    coulomb = 3,       ///< unilateral: touches and leaves; slides where friction does not hold it
};

/// Of a coulomb tool. Far above what instruments and soft matter have: what is beyond is a misplaced point,
/// not a surface.
inline constexpr double kMaxFrictionCoefficient = 10;

/// Something that touches the object, and the nodes that it can touch.
///
/// Nodes are asset node indices, strictly increasing, all of them free (not held). A bonded tool has at
/// least one; a unilateral one lists the surface nodes that the scene lets it touch.
struct ToolSet {
    std::string name;
    ToolShape shape = ToolShape::plate;
    ToolContact contact = ToolContact::bonded;
    double radius_m = 0;                     ///< sphere and capsule only, > 0
    double half_length_m = 0;                ///< capsule only, > 0: from its middle to the centre of each end
    double friction_coefficient = 0;         ///< coulomb only, > 0, at most kMaxFrictionCoefficient
    std::array<double, 2> half_extents_m{};  ///< plate only; {0, 0}: unbounded plane
    Point rest_position_m{};                 ///< pose of the tool that goes with the rest state
    std::array<double, 4> rest_orientation_wxyz{1, 0, 0, 0};  ///< unit quaternion, tool frame to scene
    std::vector<std::uint32_t> nodes;
};

/// Outer triangles for drawing; present only when the scene asks for it.
struct SurfaceMesh {
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< asset node indices, outward
};

/// A finer surface for drawing that the tetrahedra carry along; present only when the scene asks for it.
///
/// Its vertices: first those that move, one for each entry of `tetrahedron`, then the still ones, which
/// belong to a part of the object that cannot move. Moving vertex v is where the four nodes of its
/// tetrahedron are, weighted: x_v = sum over k of weights[v][k] * x[tetrahedra[tetrahedron[v]][k]]. A vertex
/// outside of its tetrahedron has negative weights: the map is the affine one of the tetrahedron, continued.
///
/// Invariants: as many weights as tetrahedra; tetrahedra exist; each weight at most kMaxEmbeddingWeight in
/// size, the four of a vertex add up to 1 within kEmbeddingWeightSumTolerance; still positions finite;
/// triangles name three different vertices; vertices only together with triangles.
struct SurfaceEmbedding {
    std::vector<std::uint32_t> tetrahedron;               ///< [moving vertices] asset tetrahedron
    std::vector<std::array<float, 4>> weights;            ///< [moving vertices]
    std::vector<Point> still_vertices_m;                  ///< [still vertices]
    std::vector<std::array<std::uint32_t, 3>> triangles;  ///< vertex indices, turned as in the surface's file

    [[nodiscard]] std::size_t vertex_count() const noexcept {
        return tetrahedron.size() + still_vertices_m.size();
    }
};

/// A vertex whose weights are larger would follow the rounding of its nodes more than their motion.
inline constexpr float kMaxEmbeddingWeight = 16;
/// Four float weights of up to 16 are off by up to half a unit of their last place each: 2e-6 together.
inline constexpr double kEmbeddingWeightSumTolerance = 1e-5;

/// What the runtime needs of one level of one object, and nothing else.
///
/// Nodes [0, free_node_count) move and stand in METIS nested-dissection order; the rest are held still.
/// Nodes and tetrahedra that cannot move or be felt are not in the asset. On disk: "/knead/asset/..."
/// (docs/format.md). Written by knead-bake, read by the runtime.
///
/// Invariants, checked by validate() and again by every reader: those of TetMesh; free_node_count <= nodes;
/// every tetrahedron has at least one free node; palette not empty, palette values as in Material; palette
/// indices < palette size; tool names unique and not empty, tool nodes as in ToolSet; embedding as in
/// SurfaceEmbedding; numbers finite.
struct Asset {
    std::string name;   ///< of the scene
    std::string level;  ///< of the level in the scene
    std::vector<Point> nodes_m;
    std::uint32_t free_node_count = 0;
    std::vector<Tetrahedron> tetrahedra;
    std::vector<PaletteEntry> palette;
    std::vector<std::uint32_t> palette_index;  ///< [tetrahedra]; one byte each on disk up to 256 entries
    std::vector<ToolSet> tools;
    Point gravity_m_per_s2{};    ///< zero: no gravity section on disk
    double damping_per_s = 0;    ///< mass-proportional damping; zero: not on disk
    SurfaceMesh surface;         ///< empty: not on disk
    SurfaceEmbedding embedding;  ///< empty: not on disk

    /// For each group of the file that the scene asked for: HDF5 path, scene key, line of the scene file.
    struct Request {
        std::string group;
        std::string scene_key;
        std::uint32_t scene_line = 0;
    };
    std::vector<Request> requests;
};

/// Checks every invariant above.
[[nodiscard]] Status validate(const Asset& asset);

}  // namespace knead
