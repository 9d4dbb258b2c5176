// SPDX-License-Identifier: Apache-2.0
#include "unit/overlap/exact_oracle.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace knead::test {
namespace {

using Exact = CGAL::Exact_rational;
using Kernel = CGAL::Simple_cartesian<Exact>;
using ExactPoint = Kernel::Point_3;
using Plane = Kernel::Plane_3;
using Hull = CGAL::Surface_mesh<ExactPoint>;

ExactPoint exact(const Point& p) {
    return {Exact(p[0]), Exact(p[1]), Exact(p[2])};
}

/// Planes of the four faces, positive side inward.
std::vector<Plane> inward_planes(const Corners& corners) {
    std::vector<Plane> planes;
    for (int opposite = 0; opposite < 4; ++opposite) {
        const Plane plane(exact(corners[(opposite + 1) % 4]), exact(corners[(opposite + 2) % 4]),
                          exact(corners[(opposite + 3) % 4]));
        planes.push_back(plane.has_on_positive_side(exact(corners[opposite])) ? plane : plane.opposite());
    }
    return planes;
}

using Row = std::array<Exact, 3>;

Exact determinant(const Row& p, const Row& q, const Row& r) {
    return CGAL::determinant(p[0], p[1], p[2], q[0], q[1], q[2], r[0], r[1], r[2]);
}

/// Cramer's rule; nothing if the planes do not meet in one point.
std::optional<ExactPoint> meeting_point(const Plane& p, const Plane& q, const Plane& r) {
    std::array<Row, 3> rows;
    Row right;
    int row = 0;
    for (const Plane* plane : {&p, &q, &r}) {
        rows[row] = {plane->a(), plane->b(), plane->c()};
        right[row++] = -plane->d();
    }
    const Exact denominator = determinant(rows[0], rows[1], rows[2]);
    if (denominator == 0) return std::nullopt;
    Row point;
    for (int column = 0; column < 3; ++column) {
        auto replaced = rows;
        for (int k = 0; k < 3; ++k)
            replaced[k][column] = right[k];
        point[column] = determinant(replaced[0], replaced[1], replaced[2]) / denominator;
    }
    return ExactPoint(point[0], point[1], point[2]);
}

std::vector<ExactPoint> corners_of_intersection(const std::vector<Plane>& planes) {
    std::vector<ExactPoint> points;
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = i + 1; j < planes.size(); ++j)
            for (std::size_t k = j + 1; k < planes.size(); ++k) {
                const auto point = meeting_point(planes[i], planes[j], planes[k]);
                if (!point) continue;
                if (std::none_of(planes.begin(), planes.end(),
                                 [&](const Plane& plane) { return plane.has_on_negative_side(*point); }))
                    points.push_back(*point);
            }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
}

/// True if no four of the points span a volume.
bool flat(const std::vector<ExactPoint>& points) {
    if (points.size() < 4) return true;
    std::size_t third = 2;  // the points are sorted and different: the first two span a line
    while (third < points.size() && CGAL::collinear(points[0], points[1], points[third]))
        ++third;
    if (third == points.size()) return true;
    return std::all_of(points.begin(), points.end(), [&](const ExactPoint& point) {
        return CGAL::coplanar(points[0], points[1], points[third], point);
    });
}

}  // namespace

double exact_volume(const Corners& corners) {
    std::array<Row, 3> edges;
    for (int edge = 0; edge < 3; ++edge)
        for (int axis = 0; axis < 3; ++axis)
            edges[edge][axis] = Exact(corners[edge + 1][axis]) - Exact(corners[0][axis]);
    return CGAL::to_double(Exact(determinant(edges[0], edges[1], edges[2]) / 6));
}

double exact_shared_volume(const Corners& a, const Corners& b) {
    std::vector<Plane> planes = inward_planes(a);
    for (const Plane& plane : inward_planes(b))
        planes.push_back(plane);
    const std::vector<ExactPoint> points = corners_of_intersection(planes);
    if (flat(points)) return 0;
    Hull hull;
    CGAL::convex_hull_3(points.begin(), points.end(), hull);
    const auto from_first = [&](const ExactPoint& p) {
        return Row{p.x() - points[0].x(), p.y() - points[0].y(), p.z() - points[0].z()};
    };
    Exact six_volumes = 0;
    for (const auto face : hull.faces()) {
        const auto edge = hull.halfedge(face);
        const auto apex = hull.source(edge);
        for (auto other = hull.next(edge); hull.target(other) != apex; other = hull.next(other))
            six_volumes +=
                determinant(from_first(hull.point(apex)), from_first(hull.point(hull.source(other))),
                            from_first(hull.point(hull.target(other))));
    }
    return CGAL::to_double(Exact(abs(six_volumes) / 6));
}

}  // namespace knead::test
