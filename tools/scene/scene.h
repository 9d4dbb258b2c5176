// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "knead/formats/asset.h"

namespace knead::tools {

/// What the mesh of an object or of a level is made from; the options of knead-mesh, lengths in metres.
struct MeshSource {
    std::string kind;                      ///< cubes, box, sphere, cylinder, ellipsoid, outline, file
    std::vector<std::uint32_t> divisions;  ///< cubes: 1 or 3
    std::vector<double> size_m;            ///< cubes, box: 1 or 3; ellipsoid: 3 radii
    double radius_m = 0;                   ///< sphere, cylinder
    double height_m = 0;                   ///< cylinder
    std::filesystem::path file;            ///< file: the mesh or surface; outline: the points
    std::string length_unit;               ///< of `file`; empty: as knead-mesh decides
    double thickness_m = 0;                ///< outline
    bool polygon = false;                  ///< outline with straight edges
    double round_m = 0;                    ///< outline: radius of its upper and lower edges
    bool merge_duplicate_nodes = false;    ///< file: a repair that the user asks for
    bool repair_orientation = false;       ///< file: likewise
    std::uint32_t target_tetrahedra = 0;   ///< 0: not given
    double edge_length_m = 0;              ///< 0: not given

    bool operator==(const MeshSource&) const = default;
};

/// Young's modulus, Poisson's ratio and density of one region.
struct RegionMaterial {
    double youngs_modulus_pa = 0;
    double poissons_ratio = 0;
    double density_kg_per_m3 = 0;
};

/// How each fine tetrahedron gets its elasticity; exactly one of the first six is set.
struct MaterialSource {
    std::optional<double> uniform_pa;
    std::optional<std::uint32_t> scenario;
    std::optional<std::string> expression_pa;
    std::filesystem::path csv;
    bool from_mesh = false;
    std::map<std::string, RegionMaterial> regions;

    std::optional<double> poissons_ratio;
    std::optional<double> density_kg_per_m3;
    std::optional<double> total_mass_kg;
    std::uint64_t seed = 1;  ///< scenario only
};

/// One baked result: how much the elasticities are simplified, and on which mesh.
struct Level {
    std::string name;
    std::uint32_t line = 0;
    std::uint32_t bins = 0;  ///< 0: raw elasticities, no clustering
    std::uint32_t clusters = 0;
    std::string binning = "equal-width";
    std::uint32_t restarts = 5;
    std::uint64_t seed = 1;
    std::string order = "stiff-first";
    std::string interest = "combined";
    double direction_weight = 0.25;
    std::string rule = "dominant";
    std::optional<MeshSource> mesh;  ///< absent: the fine mesh itself
    /// Mesh and material of the level, made beforehand (knead-tune): the keys above and `mesh` are then not
    /// given. Empty: the level is made from the scene's own.
    std::filesystem::path object;
};

/// Nodes by place. Sides are those of the mesh's bounding box: bottom -z, top +z, left -x, right +x,
/// front -y, back +y.
struct Selection {
    std::string side;  ///< empty: no side
    std::optional<std::array<Point, 2>> box_m;
    std::optional<std::pair<Point, double>> ball_m;  ///< centre, radius
    std::string scene_key;                           ///< "held[0]", for messages
    std::uint32_t line = 0;
};

/// A tool of the scene and the part of the surface that it may touch.
struct SceneTool {
    std::string name;
    ToolShape shape = ToolShape::plate;
    ToolContact contact = ToolContact::bonded;
    double radius_m = 0;              ///< sphere, capsule
    double half_length_m = 0;         ///< capsule
    double friction_coefficient = 0;  ///< coulomb
    std::array<double, 2> half_extents_m{};
    std::optional<Point> position_m;  ///< absent: touching the highest node that it may touch
    std::array<double, 4> orientation_wxyz{1, 0, 0, 0};
    Selection touches;
    std::uint32_t line = 0;
};

/// A finer surface to be carried along for drawing.
struct EmbeddingSource {
    std::filesystem::path file;  ///< STL or PLY
    double metres_per_unit = 1;
    double max_distance_m = 0;  ///< 0: not given
    std::uint32_t line = 0;
};

/// A scene file (docs/scene.md): what the object is, what holds it, what touches it and how, which levels to
/// bake and what the application needs. Paths are resolved against the scene file's folder.
struct Scene {
    std::filesystem::path file;
    std::string name;
    MeshSource mesh;
    MaterialSource material;
    std::uint32_t material_line = 0;
    std::uint32_t mesh_line = 0;
    std::vector<Level> levels;     ///< at least one, names unique
    std::vector<Selection> held;   ///< may be empty: a free-floating body
    std::vector<SceneTool> tools;  ///< at least one, names unique
    Point gravity_m_per_s2{};
    std::uint32_t gravity_line = 0;
    double damping_per_s = 0;
    std::uint32_t damping_line = 0;
    bool needs_surface = false;
    std::uint32_t surface_line = 0;
    std::optional<EmbeddingSource> embedding;

    [[nodiscard]] const Level& level(const std::string& level_name) const;  ///< throws bad_usage if unknown
};

/// Reads and checks a scene. Throws ToolError(bad_input) whose message starts with "file:line:" and, for an
/// unknown key, names the nearest known one.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file);

/// The same of a text that stands in `file`.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::filesystem::path& file);

}  // namespace knead::tools
