// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fuzz/text_target.h"
#include "knead/formats/tet_mesh.h"
#include "mesh/repair.h"
#include "mesh/surface.h"
#include "quality/mesh_quality.h"

namespace knead::fuzz {

/// A mesh that a reader accepted goes on as in knead-mesh import, with all repairs, and comes out valid.
inline void finish_mesh(tools::RawMesh raw) {
    tools::RepairOptions options;
    options.metres_per_unit = 1e-3;
    options.merge_duplicate_nodes = true;
    options.repair_orientation = true;
    const tools::RepairedMesh repaired = tools::to_tet_mesh(std::move(raw), options);
    // Names of regions and arrays are the writer's to check.
    TetMesh geometry;
    geometry.nodes_m = repaired.mesh.nodes_m;
    geometry.tetrahedra = repaired.mesh.tetrahedra;
    expect(validate(geometry).ok(), "an imported mesh is valid");
    expect(repaired.mesh.regions.region_of_tetrahedron.empty() ||
               repaired.mesh.regions.region_of_tetrahedron.size() == geometry.tetrahedra.size(),
           "each tetrahedron has a region");
    (void)tools::remarks(repaired.mesh, tools::measure(repaired.mesh));
}

inline void finish_surface(tools::TriangleSurface surface) {
    for (const auto& triangle : surface.triangles)
        for (const std::uint32_t corner : triangle)
            expect(corner < surface.points.size(), "corners are points");
    const std::size_t triangles = surface.triangles.size();
    const tools::ClosedSurface closed = tools::require_closed(std::move(surface));
    expect(closed.shell_of_triangle.size() == triangles, "each triangle has a shell");
}

}  // namespace knead::fuzz
