// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/import.h"

#include "common/error.h"
#include "mesh/gmsh_import.h"
#include "mesh/gmsh_surface.h"
#include "mesh/medit.h"
#include "mesh/recognise.h"
#include "mesh/surface.h"
#include "mesh/vtk.h"

namespace knead::tools {
namespace {

bool is_mesh(FileFormat format) {
    return format == FileFormat::msh || format == FileFormat::medit || format == FileFormat::vtk ||
           format == FileFormat::veg;
}

void require_fitting_options(FileFormat format, const ImportRequest& request) {
    const std::string what = description(format);
    if (needs_length_unit(format) && !request.metres_per_unit)
        fail_usage(what + " has no length unit: say --length-unit mm, or what it is");
    if (!needs_length_unit(format) && request.metres_per_unit)
        fail_usage(what + " knows its length unit: leave out --length-unit");
    if (is_mesh(format) && (request.size.target_tetrahedra || request.size.edge_length_m))
        fail_usage(what +
                   " is a mesh already: --target-tetrahedra and --edge-length are for solids and surfaces");
    if (!is_mesh(format) && (request.merge_duplicate_nodes || request.repair_orientation))
        fail_usage(what + " is not a mesh: --merge-duplicate-nodes and --repair-orientation are for meshes");
}

RawMesh read_mesh(FileFormat format, std::string_view content, const ImportRequest& request) {
    switch (format) {
        case FileFormat::medit:
            return read_medit(content);
        case FileFormat::vtk:
            return read_vtk(content);
        case FileFormat::veg:
            return read_veg(content, request.include);
        default:
            return read_msh(content);
    }
}

TriangleSurface read_surface(FileFormat format, std::string_view content) {
    switch (format) {
        case FileFormat::stl_text:
            return read_stl_text(content);
        case FileFormat::stl_binary:
            return read_stl_binary(content);
        default:
            return read_ply(content);
    }
}

MadeMesh mesh_closed_surface(FileFormat format, std::string_view content, const ImportRequest& request) {
    const ClosedSurface closed = require_closed(read_surface(format, content));
    MadeMesh made = finish(mesh_surface(closed, request.size, *request.metres_per_unit), description(format));
    made.notes.insert(made.notes.begin(), closed.surface.notes.begin(), closed.surface.notes.end());
    return made;
}

}  // namespace

MadeMesh finish(GeneratedMesh generated, const std::string& source) {
    RepairOptions options;
    options.metres_per_unit = generated.metres_per_unit;
    RepairedMesh repaired = to_tet_mesh(std::move(generated.raw), options);
    return {std::move(repaired.mesh), std::move(repaired.notes), source, generated.edge_length_m,
            generated.meshings};
}

MadeMesh import_mesh(std::string_view content, const ImportRequest& request) {
    const FileFormat format = recognise(content);
    require_matching_extension(format, request.extension);
    require_fitting_options(format, request);
    if (format == FileFormat::step || format == FileFormat::brep)
        return finish(mesh_cad(content, format, request.metres_per_unit.value_or(1), request.size),
                      description(format));
    if (!is_mesh(format)) return mesh_closed_surface(format, content, request);
    RepairOptions options;
    options.metres_per_unit = *request.metres_per_unit;
    options.merge_duplicate_nodes = request.merge_duplicate_nodes;
    options.repair_orientation = request.repair_orientation;
    RepairedMesh repaired = to_tet_mesh(read_mesh(format, content, request), options);
    return {std::move(repaired.mesh), std::move(repaired.notes), description(format), 0, 0};
}

}  // namespace knead::tools
