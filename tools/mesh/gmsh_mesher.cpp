// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/gmsh_mesher.h"

#include <fmt/format.h>
#include <gmsh.h>

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "mesh/gmsh_session.h"
#include "mesh/size_search.h"

namespace knead::tools {
namespace {

/// Without a wish, this many edges along the longest side of the object.
constexpr double kDefaultEdgesAcross = 12;
/// The first trial of a search: coarse, hence quick.
constexpr double kFirstTrialEdgesAcross = 8;
/// An edge length that would make more tetrahedra than this is refused before gmsh fills the memory.
constexpr double kMaxTetrahedra = 50e6;

struct Extent {
    double longest = 0;
    double box_volume = 1;
};

Extent model_extent() {
    double low[3];
    double high[3];
    gmsh::model::getBoundingBox(-1, -1, low[0], low[1], low[2], high[0], high[1], high[2]);
    Extent extent;
    for (int axis = 0; axis < 3; ++axis) {
        extent.longest = std::max(extent.longest, high[axis] - low[axis]);
        extent.box_volume *= high[axis] - low[axis];
    }
    if (!(extent.longest > 0)) fail_input("the geometry is empty");
    return extent;
}

std::size_t count_tetrahedra() {
    std::vector<std::size_t> elements;
    std::vector<std::size_t> nodes;
    gmsh::model::mesh::getElementsByType(4, elements, nodes);
    return elements.size();
}

std::size_t generate(const std::function<void()>& build, double edge_length) {
    gmsh::clear();
    call_gmsh(ExitCode::no_valid_result, "cannot make the geometry", build);
    gmsh::option::setNumber("Mesh.MeshSizeMin", edge_length);
    gmsh::option::setNumber("Mesh.MeshSizeMax", edge_length);
    call_gmsh(ExitCode::no_valid_result, "cannot mesh the geometry", [] { gmsh::model::mesh::generate(3); });
    const std::size_t count = count_tetrahedra();
    if (count == 0) fail_result("gmsh made no tetrahedra of this geometry");
    return count;
}

/// One trial of a search. gmsh fails at some sizes of a difficult surface and not at those beside them.
std::size_t generate_near(const std::function<void()>& build, double& edge_length) {
    constexpr double kDetours[] = {0.97, 1.04, 0.92};
    const double wished = edge_length;
    for (const double detour : kDetours) {
        try {
            return generate(build, edge_length);
        } catch (const ToolError&) {
            edge_length = wished * detour;
        }
    }
    return generate(build, edge_length);
}

void require_possible(const Extent& extent, const MeshSize& size, double metres_per_unit) {
    if (size.target_tetrahedra && static_cast<double>(*size.target_tetrahedra) > kMaxTetrahedra)
        fail_usage(fmt::format("more than {:g} tetrahedra are not meshed", kMaxTetrahedra));
    if (!size.edge_length_m) return;
    const double edge = *size.edge_length_m / metres_per_unit;
    if (extent.box_volume / (0.12 * edge * edge * edge) > 4 * kMaxTetrahedra)
        fail_usage(
            fmt::format("an edge length of {:g} m is too small for this object: more than {:g} tetrahedra",
                        *size.edge_length_m, kMaxTetrahedra));
}

}  // namespace

GeneratedMesh mesh_to_size(const std::function<void()>& build, const MeshSize& size, double metres_per_unit) {
    gmsh::clear();
    call_gmsh(ExitCode::no_valid_result, "cannot make the geometry", build);
    const Extent extent = model_extent();
    require_possible(extent, size, metres_per_unit);
    GeneratedMesh generated;
    generated.metres_per_unit = metres_per_unit;
    double edge_length =
        size.edge_length_m ? *size.edge_length_m / metres_per_unit : extent.longest / kDefaultEdgesAcross;
    double meshed_with = 0;
    Notes notes;
    if (size.target_tetrahedra) {
        const SizeSearchResult found = search_edge_length(
            *size.target_tetrahedra, extent.longest / kFirstTrialEdgesAcross, [&](double& length) {
                const std::size_t count = generate_near(build, length);
                meshed_with = length;
                return count;
            });
        edge_length = found.edge_length;
        generated.meshings = found.meshings;
        if (!found.within_tolerance)
            notes.push_back({true, fmt::format("{} tetrahedra wanted, {} are the nearest found",
                                               *size.target_tetrahedra, found.count)});
    }
    if (meshed_with != edge_length) generate(build, edge_length);
    generated.edge_length_m = edge_length * metres_per_unit;
    generated.raw = extract_mesh(ExtractNodes::of_volumes);
    generated.raw.notes = std::move(notes);
    generated.raw.other_cells.clear();  // the surface's triangles: nobody asked for them
    return generated;
}

}  // namespace knead::tools
