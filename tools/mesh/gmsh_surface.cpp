// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/gmsh_surface.h"

#include <gmsh.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "common/error.h"
#include "mesh/gmsh_session.h"

namespace knead::tools {
namespace {

constexpr double kSharpEdge_rad = 40 * std::numbers::pi / 180;
constexpr int kTriangle = 2;  // gmsh's element type
/// Surfaces are meshed at about this size, far from gmsh's absolute tolerances.
constexpr double kModelSize = 100;

/// Where the model of gmsh stands relative to the file: same shape, friendly size.
struct Placement {
    double model_per_unit = 1;

    explicit Placement(const TriangleSurface& surface) {
        double longest = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const auto [low, high] =
                std::minmax_element(surface.points.begin(), surface.points.end(),
                                    [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
            longest = std::max(longest, (*high)[axis] - (*low)[axis]);
        }
        // A power of two: scaling there and back changes no bit of a coordinate.
        if (longest > 0) model_per_unit = std::exp2(std::round(std::log2(kModelSize / longest)));
    }
    [[nodiscard]] Point to_model(const Point& p) const {
        return {p[0] * model_per_unit, p[1] * model_per_unit, p[2] * model_per_unit};
    }
};

/// One discrete surface per shell, with tags 1, 2, ...
void add_shells(const ClosedSurface& closed, const Placement& placement, std::size_t shells) {
    const TriangleSurface& surface = closed.surface;
    std::vector<std::vector<std::size_t>> node_tags(shells);
    std::vector<std::vector<double>> coordinates(shells);
    std::vector<std::vector<std::size_t>> corners(shells);
    std::vector<char> placed(surface.points.size(), 0);
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const std::uint32_t shell = closed.shell_of_triangle[t];
        for (const std::uint32_t point : surface.triangles[t]) {
            corners[shell].push_back(point + 1);
            if (placed[point] != 0) continue;
            placed[point] = 1;
            node_tags[shell].push_back(point + 1);
            const Point at = placement.to_model(surface.points[point]);
            coordinates[shell].insert(coordinates[shell].end(), at.begin(), at.end());
        }
    }
    for (std::size_t shell = 0; shell < shells; ++shell) {
        const int tag = static_cast<int>(shell) + 1;
        gmsh::model::addDiscreteEntity(2, tag);
        gmsh::model::mesh::addNodes(2, tag, node_tags[shell], coordinates[shell]);
    }
    for (std::size_t shell = 0; shell < shells; ++shell)
        gmsh::model::mesh::addElementsByType(static_cast<int>(shell) + 1, kTriangle, {}, corners[shell]);
}

/// Splits the discrete surfaces along sharp edges and gives them a geometry that can be meshed anew. Returns
/// the faces of every shell, found by the place of one of their corners.
std::vector<std::vector<int>> make_remeshable(const ClosedSurface& closed, const Placement& placement,
                                              std::size_t shells) {
    std::map<Point, std::uint32_t> shell_at;
    for (std::size_t t = 0; t < closed.surface.triangles.size(); ++t)
        for (const std::uint32_t point : closed.surface.triangles[t])
            shell_at.try_emplace(placement.to_model(closed.surface.points[point]),
                                 closed.shell_of_triangle[t]);
    gmsh::model::mesh::classifySurfaces(kSharpEdge_rad, true, true, std::numbers::pi);
    gmsh::model::mesh::createGeometry();
    std::vector<std::vector<int>> faces(shells);
    gmsh::vectorpair entities;
    gmsh::model::getEntities(entities, 2);
    for (const auto& [dim, tag] : entities) {
        std::vector<std::size_t> elements;
        std::vector<std::size_t> nodes;
        gmsh::model::mesh::getElementsByType(kTriangle, elements, nodes, tag);
        if (nodes.empty()) continue;
        std::vector<double> at;
        std::vector<double> unused;
        gmsh::model::mesh::getNode(nodes[0], at, unused);
        const auto found = shell_at.find({at[0], at[1], at[2]});
        if (found == shell_at.end()) fail_result("gmsh moved a corner of the surface");
        faces[found->second].push_back(tag);
    }
    return faces;
}

void build_model(const ClosedSurface& closed, const Placement& placement, bool remesh) {
    const std::size_t shells =
        1 + *std::max_element(closed.shell_of_triangle.begin(), closed.shell_of_triangle.end());
    add_shells(closed, placement, shells);
    std::vector<std::vector<int>> faces(shells);
    for (std::size_t shell = 0; shell < shells; ++shell)
        faces[shell] = {static_cast<int>(shell) + 1};
    if (remesh) faces = make_remeshable(closed, placement, shells);
    for (const auto& body : closed.bodies) {
        std::vector<int> loops;
        for (const std::uint32_t shell : body)
            loops.push_back(gmsh::model::geo::addSurfaceLoop(faces[shell]));
        gmsh::model::geo::addVolume(loops);
    }
    gmsh::model::geo::synchronize();
}

}  // namespace

GeneratedMesh mesh_surface(const ClosedSurface& closed, const MeshSize& size, double metres_per_unit) {
    const GmshSession session;
    const Placement placement(closed.surface);
    const bool remesh = size.target_tetrahedra || size.edge_length_m;
    if (!remesh) gmsh::option::setNumber("Mesh.MeshSizeExtendFromBoundary", 1);
    GeneratedMesh generated = mesh_to_size([&] { build_model(closed, placement, remesh); }, size,
                                           metres_per_unit / placement.model_per_unit);
    if (!remesh) generated.edge_length_m = 0;
    return generated;
}

}  // namespace knead::tools
