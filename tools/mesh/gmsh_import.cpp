// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/gmsh_import.h"

#include <fmt/format.h>
#include <gmsh.h>

#include "common/error.h"
#include "mesh/gmsh_session.h"

namespace knead::tools {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;  // GmshSession asks OpenCASCADE for millimetres

void import_solids(const PrivateCopy& file, FileFormat format) {
    gmsh::vectorpair shapes;
    call_gmsh(ExitCode::bad_input, std::string("cannot read ") + description(format), [&] {
        gmsh::model::occ::importShapes(file.path(), shapes, true,
                                       format == FileFormat::step ? "step" : "brep");
    });
    gmsh::vectorpair solids;
    for (const auto& shape : shapes)
        if (shape.first == 3) solids.push_back(shape);
    if (solids.empty())
        fail_input(std::string(description(format)) + " without a solid: nothing to fill with tetrahedra");
    if (solids.size() > 1) gmsh::model::occ::removeAllDuplicates();
    gmsh::model::occ::synchronize();
    gmsh::vectorpair volumes;
    gmsh::model::getEntities(volumes, 3);
    if (volumes.size() < 2) return;
    for (const auto& [dim, tag] : volumes)
        gmsh::model::setPhysicalName(3, gmsh::model::addPhysicalGroup(3, {tag}),
                                     fmt::format("volume_{}", tag));
}

}  // namespace

RawMesh read_msh(std::string_view content) {
    const PrivateCopy file(content, ".msh");
    const auto read = [&] {
        const GmshSession session;
        call_gmsh(ExitCode::bad_input, "gmsh cannot read this MSH file", [&] { gmsh::merge(file.path()); });
        return extract_mesh(ExtractNodes::all);
    };
    require_no_crash([&] { (void)read(); });
    return read();
}

GeneratedMesh mesh_cad(std::string_view content, FileFormat format, double metres_per_unit,
                       const MeshSize& size) {
    const PrivateCopy file(content, format == FileFormat::step ? ".step" : ".brep");
    const double unit = format == FileFormat::step ? kMetresPerMillimetre : metres_per_unit;
    const auto mesh = [&](const MeshSize& wanted) {
        const GmshSession session;
        return mesh_to_size([&] { import_solids(file, format); }, wanted, unit);
    };
    require_no_crash([&] { (void)mesh({}); });  // at the coarse default size
    return mesh(size);
}

}  // namespace knead::tools
