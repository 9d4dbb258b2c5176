// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "evaluate/surface_region.h"
#include "reference/static_problem.h"

namespace knead::tools {

/// A turn about an axis through a pivot, then a shift.
struct RigidMotion {
    Point pivot_m{};
    Point axis{0, 0, 1};  ///< unit length
    double angle_rad = 0;
    Point translation_m{};

    [[nodiscard]] Point place_of(const Point& rest_m) const;
};

/// What a rigid tool bonded to a part of the surface does to an object, whatever mesh the object has.
///
/// The felt force is what the hand works against: the object's reaction against `felt_translation`, and its
/// moment about `motion.pivot_m` against `felt_turn_per_m`.
struct Load {
    std::string name;
    SurfaceRegion region;
    RigidMotion motion;
    Point felt_translation{};  ///< unit length or zero
    Point felt_turn_per_m{};   ///< axis over the lever that makes a force of the moment, or zero
};

/// Names of the loads that every object can be given, in the order of the tables.
[[nodiscard]] const std::vector<std::string>& named_loads();

/// One of named_loads() for an object with this bounding box: lengths are shares of it, those of the paper's
/// cube of 0.1 m in brackets (docs/evaluation.md has the table).
/// @throws ToolError(bad_usage) for another name
[[nodiscard]] Load named_load(const std::string& name, const Box& object);

/// A load as a mesh carries it out.
struct AppliedLoad {
    PrescribedMotion motion;  ///< the first `held_count` nodes are held, the others are the tool's
    std::size_t held_count = 0;
    std::vector<Point> work_directions;  ///< [tool nodes, then ties] how a unit of the felt motion moves them
};

/// The load on one mesh.
///
/// Nodes under the tool follow it. Where the tool covers a triangle in part, its other corners are not under
/// the tool; the surface is then held to the tool on average only: for each node m under the tool,
/// integral over the covered area of (shape function of m) * (surface - tool) = 0. On a mesh that has nodes
/// along the tool's border this is the plain prescribed motion. The tool's area is the same on every mesh.
/// Where no node is under the tool, the one with the largest share of it stands for it.
/// @param is_held [nodes]
/// @throws ToolError(bad_input) when the mesh has no such surface, or the tool touches held nodes
[[nodiscard]] AppliedLoad apply_load(const Load& load, const TetMesh& mesh, const std::vector<bool>& is_held);
/// The same where the region is known already.
/// @param region mesh_region() of the load
[[nodiscard]] AppliedLoad apply_load(const Load& load, const MeshedRegion& region, const TetMesh& mesh,
                                     const std::vector<bool>& is_held);

/// The felt force of a solution, newtons; positive when the object resists.
[[nodiscard]] double felt_force_n(const AppliedLoad& load, const StaticSolution& solution);

}  // namespace knead::tools
