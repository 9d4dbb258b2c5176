// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/skin.h"

#include "common/error.h"
#include "mesh/recognise.h"
#include "mesh/surface.h"

namespace knead::tools {
namespace {

TriangleSurface read_surface(std::string_view content, const std::string& extension) {
    const FileFormat format = recognise(content);
    require_matching_extension(format, extension);
    switch (format) {
        case FileFormat::stl_text:
            return read_stl_text(content);
        case FileFormat::stl_binary:
            return read_stl_binary(content);
        case FileFormat::ply:
            return read_ply(content);
        default:
            fail_input(std::string("holds ") + description(format) + " where STL or PLY is wanted");
    }
}

}  // namespace

Skin read_skin(std::string_view content, const std::string& extension, double metres_per_unit) {
    TriangleSurface surface = read_surface(content, extension);
    Skin skin;
    skin.vertices_m = std::move(surface.points);
    for (Point& vertex : skin.vertices_m)
        for (double& coordinate : vertex)
            coordinate *= metres_per_unit;
    skin.triangles = std::move(surface.triangles);
    for (Note& note : surface.notes)
        skin.notes.push_back(std::move(note.text));
    return skin;
}

}  // namespace knead::tools
