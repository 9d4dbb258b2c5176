// SPDX-License-Identifier: GPL-3.0-or-later
#include "quality/tet_shape.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace knead::tools {
namespace {

Point minus(const Point& a, const Point& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
double length(const Point& a) {
    return std::sqrt(dot(a, a));
}

/// Twice the area of each face times its normal; all four point the same way (out or in).
std::array<Point, 4> face_normals(const std::array<Point, 4>& p) {
    return {cross(minus(p[2], p[1]), minus(p[3], p[1])), cross(minus(p[3], p[0]), minus(p[2], p[0])),
            cross(minus(p[1], p[0]), minus(p[3], p[0])), cross(minus(p[2], p[0]), minus(p[1], p[0]))};
}

/// Circumscribed radius times 24 V, from the products of opposite edges (Crelle's formula).
double circumscribed_by_volume(const std::array<Point, 4>& x) {
    const double p = length(minus(x[0], x[1])) * length(minus(x[2], x[3]));
    const double q = length(minus(x[0], x[2])) * length(minus(x[1], x[3]));
    const double r = length(minus(x[0], x[3])) * length(minus(x[1], x[2]));
    return std::sqrt(std::max(0.0, (p + q + r) * (p + q - r) * (p - q + r) * (-p + q + r)));
}

}  // namespace

TetShape shape_of(const Point& a, const Point& b, const Point& c, const Point& d) {
    const std::array<Point, 4> corners{a, b, c, d};
    TetShape shape;
    double squares_m2 = 0;
    shape.shortest_edge_m = length(minus(b, a));
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) {
            const double edge = length(minus(corners[j], corners[i]));
            squares_m2 += edge * edge;
            shape.mean_edge_m += edge / 6;
            shape.shortest_edge_m = std::min(shape.shortest_edge_m, edge);
            shape.longest_edge_m = std::max(shape.longest_edge_m, edge);
        }

    const std::array<Point, 4> normals = face_normals(corners);
    double area_m2 = 0;
    double largest_area_m2 = 0;
    for (const Point& normal : normals) {
        area_m2 += 0.5 * length(normal);
        largest_area_m2 = std::max(largest_area_m2, 0.5 * length(normal));
    }
    // The angle inside is what is missing to a straight one between the normals.
    shape.min_dihedral_deg = 180;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) {
            const double angle =
                std::atan2(length(cross(normals[i], normals[j])), -dot(normals[i], normals[j]));
            shape.min_dihedral_deg = std::min(shape.min_dihedral_deg, angle * 180 / std::numbers::pi);
            shape.max_dihedral_deg = std::max(shape.max_dihedral_deg, angle * 180 / std::numbers::pi);
        }

    const double volume_m3 = std::abs(signed_volume_m3(a, b, c, d));
    const double circumscribed = circumscribed_by_volume(corners);
    if (volume_m3 <= 0 || area_m2 <= 0 || circumscribed <= 0) return shape;
    shape.radius_ratio = 3 * (3 * volume_m3 / area_m2) * 24 * volume_m3 / circumscribed;
    shape.mean_ratio = 12 * std::pow(3 * volume_m3, 2.0 / 3) / squares_m2;
    shape.smallest_height_m = 3 * volume_m3 / largest_area_m2;
    shape.thinness = shape.smallest_height_m / shape.longest_edge_m;
    return shape;
}

}  // namespace knead::tools
