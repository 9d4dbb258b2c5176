// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/gmsh_primitives.h"

#include <gmsh.h>

#include <cmath>
#include <string>

#include "common/error.h"
#include "mesh/gmsh_session.h"

namespace knead::tools {
namespace {

/// OpenCASCADE works with an absolute tolerance of 1e-7, made for millimetres.
constexpr double kMetresPerUnit = 1e-3;
double mm(double metres) {
    return metres / kMetresPerUnit;
}

void require_length(double length_m, const char* what) {
    if (!std::isfinite(length_m) || length_m <= 0)
        fail_usage(std::string(what) + " must be finite and greater than 0");
}

GeneratedMesh mesh_solid(const MeshSize& size, const std::function<void()>& build) {
    const GmshSession session;
    return mesh_to_size(
        [&] {
            build();
            gmsh::model::occ::synchronize();
        },
        size, kMetresPerUnit);
}

/// The closed curve or polygon; returns the tag of the flat face inside it.
int add_face(const OutlineSlab& slab) {
    namespace occ = gmsh::model::occ;
    std::vector<int> points;
    for (const auto& corner : slab.corners_m)
        points.push_back(occ::addPoint(mm(corner[0]), mm(corner[1]), 0));
    std::vector<int> curves;
    if (slab.polygon) {
        for (std::size_t i = 0; i < points.size(); ++i)
            curves.push_back(occ::addLine(points[i], points[(i + 1) % points.size()]));
    } else {
        points.push_back(points.front());
        curves.push_back(occ::addSpline(points));
    }
    return occ::addPlaneSurface({occ::addCurveLoop(curves)});
}

/// The edges of a volume that lie in z = 0 or z = thickness.
std::vector<int> flat_edges(int volume, double thickness) {
    gmsh::vectorpair faces;
    gmsh::vectorpair edges;
    gmsh::model::occ::synchronize();
    gmsh::model::getBoundary({{3, volume}}, faces, false, false, false);
    gmsh::model::getBoundary(faces, edges, false, false, false);
    std::vector<int> flat;
    for (const auto& [dim, edge] : edges) {
        double low[3];
        double high[3];
        gmsh::model::occ::getBoundingBox(dim, edge, low[0], low[1], low[2], high[0], high[1], high[2]);
        const bool level = high[2] - low[2] < 0.01 * thickness;
        if (level && std::find(flat.begin(), flat.end(), edge) == flat.end()) flat.push_back(edge);
    }
    return flat;
}

void add_slab(const OutlineSlab& slab) {
    namespace occ = gmsh::model::occ;
    gmsh::vectorpair made;
    occ::extrude({{2, add_face(slab)}}, 0, 0, mm(slab.thickness_m), made);
    if (slab.round_m == 0) return;
    for (const auto& [dim, tag] : gmsh::vectorpair(made)) {
        if (dim != 3) continue;
        gmsh::vectorpair rounded;
        occ::fillet({tag}, flat_edges(tag, mm(slab.thickness_m)), {mm(slab.round_m)}, rounded);
    }
}

}  // namespace

GeneratedMesh mesh_box(const std::array<double, 3>& size_m, const MeshSize& size) {
    for (const double side : size_m)
        require_length(side, "each side of the box");
    return mesh_solid(
        size, [&] { gmsh::model::occ::addBox(0, 0, 0, mm(size_m[0]), mm(size_m[1]), mm(size_m[2])); });
}

GeneratedMesh mesh_sphere(double radius_m, const MeshSize& size) {
    require_length(radius_m, "the radius");
    return mesh_solid(size, [&] { gmsh::model::occ::addSphere(0, 0, 0, mm(radius_m)); });
}

GeneratedMesh mesh_cylinder(double radius_m, double height_m, const MeshSize& size) {
    require_length(radius_m, "the radius");
    require_length(height_m, "the height");
    return mesh_solid(size,
                      [&] { gmsh::model::occ::addCylinder(0, 0, 0, 0, 0, mm(height_m), mm(radius_m)); });
}

GeneratedMesh mesh_ellipsoid(const std::array<double, 3>& radii_m, const MeshSize& size) {
    for (const double radius : radii_m)
        require_length(radius, "each radius");
    return mesh_solid(size, [&] {
        const int ball = gmsh::model::occ::addSphere(0, 0, 0, 1);
        gmsh::model::occ::dilate({{3, ball}}, 0, 0, 0, mm(radii_m[0]), mm(radii_m[1]), mm(radii_m[2]));
    });
}

GeneratedMesh mesh_outline(const OutlineSlab& slab, const MeshSize& size) {
    require_length(slab.thickness_m, "the thickness");
    if (!std::isfinite(slab.round_m) || slab.round_m < 0 || 2 * slab.round_m >= slab.thickness_m)
        fail_usage("the radius of the rounded edges must be 0 or more and less than half of the thickness");
    try {
        return mesh_solid(size, [&] { add_slab(slab); });
    } catch (const ToolError& error) {
        if (slab.round_m == 0 || error.code() != ExitCode::no_valid_result) throw;
        fail_result(std::string(error.what()) +
                    "; rounded edges at sharp corners often fail: try without --round");
    }
}

}  // namespace knead::tools
