// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/surface_region.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "bake/surface.h"

namespace knead::tools {
namespace {

/// cos 45 degrees, a little less: faces at exactly 45 degrees belong to the region on every mesh.
constexpr double kFacing = 0.7071;
/// Of the box's longest edge: meshers leave rounding of about 1e-9 of the size.
constexpr double kBorderTolerance = 1e-6;
/// Share of a triangle below which a covered corner of it is rounding.
constexpr double kSliver = 1e-9;

using Eigen::Vector3d;

Vector3d vector_of(const Point& point) {
    return {point[0], point[1], point[2]};
}

/// A corner of a cut triangle, in space and in terms of the triangle's corners.
struct Corner {
    Vector3d place;
    Vector3d weights;
};

/// What of a convex polygon is at most `limit` along an axis (sign 1) or at least it (sign -1).
std::vector<Corner> cut(const std::vector<Corner>& polygon, int axis, double sign, double limit) {
    std::vector<Corner> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Corner& a = polygon[k];
        const Corner& b = polygon[(k + 1) % polygon.size()];
        const double beyond_a = sign * (a.place[axis] - limit);
        const double beyond_b = sign * (b.place[axis] - limit);
        if (beyond_a <= 0) kept.push_back(a);
        if ((beyond_a < 0 && beyond_b > 0) || (beyond_a > 0 && beyond_b < 0)) {
            const double share = beyond_a / (beyond_a - beyond_b);
            kept.push_back(
                {a.place + share * (b.place - a.place), a.weights + share * (b.weights - a.weights)});
        }
    }
    return kept;
}

std::vector<Corner> cut(std::vector<Corner> polygon, const Box& box) {
    for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        polygon = cut(polygon, axis, 1, box.high_m[at]);
        polygon = cut(polygon, axis, -1, box.low_m[at]);
    }
    return polygon;
}

/// Integrals over the part of one triangle, by its three corners.
struct Integrals {
    double area_m2 = 0;
    Vector3d shapes = Vector3d::Zero();
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
};

Integrals integrate(const std::vector<Corner>& polygon) {
    Integrals sum;
    for (std::size_t k = 2; k < polygon.size(); ++k) {
        const Corner& a = polygon[0];
        const Corner& b = polygon[k - 1];
        const Corner& c = polygon[k];
        const double area = (b.place - a.place).cross(c.place - a.place).norm() / 2;
        const Vector3d total = a.weights + b.weights + c.weights;
        sum.area_m2 += area;
        sum.shapes += area / 3 * total;
        sum.products += area / 12 *
                        (total * total.transpose() + a.weights * a.weights.transpose() +
                         b.weights * b.weights.transpose() + c.weights * c.weights.transpose());
    }
    return sum;
}

bool is_within(const Point& place, const Box& box, double tolerance_m) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (place[axis] < box.low_m[axis] - tolerance_m || place[axis] > box.high_m[axis] + tolerance_m)
            return false;
    return true;
}

struct CoveredTriangle {
    Triangle nodes;
    Integrals integrals;
};

std::vector<CoveredTriangle> covered_triangles(const TetMesh& mesh, const std::vector<Triangle>& outer,
                                               const SurfaceRegion& region) {
    std::vector<CoveredTriangle> covered;
    for (const Triangle& triangle : outer) {
        std::vector<Corner> polygon;
        for (int k = 0; k < 3; ++k)
            polygon.push_back(
                {vector_of(mesh.nodes_m[triangle[static_cast<std::size_t>(k)]]), Vector3d::Unit(k)});
        const Vector3d normal =
            (polygon[1].place - polygon[0].place).cross(polygon[2].place - polygon[0].place);
        if (normal.dot(vector_of(region.facing)) < kFacing * normal.norm()) continue;
        const Integrals integrals = integrate(cut(polygon, region.within));
        if (integrals.area_m2 > kSliver * normal.norm() / 2) covered.push_back({triangle, integrals});
    }
    return covered;
}

}  // namespace

Box bounding_box(const std::vector<Point>& nodes_m) {
    Box box{nodes_m.front(), nodes_m.front()};
    for (const Point& node : nodes_m)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low_m[axis] = std::min(box.low_m[axis], node[axis]);
            box.high_m[axis] = std::max(box.high_m[axis], node[axis]);
        }
    return box;
}

MeshedRegion mesh_region(const TetMesh& mesh, const SurfaceRegion& region) {
    return mesh_region(mesh, boundary_triangles(mesh.tetrahedra), region);
}

MeshedRegion mesh_region(const TetMesh& mesh, const std::vector<Triangle>& outer,
                         const SurfaceRegion& region) {
    const std::vector<CoveredTriangle> covered = covered_triangles(mesh, outer, region);
    std::map<std::uint32_t, std::size_t> position;
    for (const CoveredTriangle& triangle : covered)
        for (const std::uint32_t node : triangle.nodes)
            position.emplace(node, 0);
    MeshedRegion meshed;
    const Point size = bounding_box(mesh.nodes_m).size_m();
    const double tolerance = kBorderTolerance * *std::max_element(size.begin(), size.end());
    for (auto& [node, at] : position) {
        at = meshed.nodes.size();
        meshed.nodes.push_back(node);
        meshed.is_inside.push_back(is_within(mesh.nodes_m[node], region.within, tolerance));
    }
    const std::size_t count = meshed.nodes.size();
    meshed.areas_m2.assign(count, 0);
    meshed.products_m2.assign(count * count, 0);
    for (const CoveredTriangle& triangle : covered) {
        meshed.area_m2 += triangle.integrals.area_m2;
        for (std::size_t a = 0; a < 3; ++a) {
            const std::size_t row = position.at(triangle.nodes[a]);
            meshed.areas_m2[row] += triangle.integrals.shapes[static_cast<int>(a)];
            for (std::size_t b = 0; b < 3; ++b)
                meshed.products_m2[row * count + position.at(triangle.nodes[b])] +=
                    triangle.integrals.products(static_cast<int>(a), static_cast<int>(b));
        }
    }
    return meshed;
}

}  // namespace knead::tools
