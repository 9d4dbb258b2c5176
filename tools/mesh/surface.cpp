// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "common/error.h"
#include "quality/union_find.h"

namespace knead::tools {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

struct EdgeUse {
    Edge edge;
    std::uint32_t triangle;
};

/// Every side of every triangle, sorted so that the uses of one edge stand together.
std::vector<EdgeUse> sorted_edges(const TriangleSurface& surface) {
    std::vector<EdgeUse> uses;
    uses.reserve(3 * surface.triangles.size());
    for (std::uint32_t t = 0; t < surface.triangles.size(); ++t)
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t a = surface.triangles[t][side];
            const std::uint32_t b = surface.triangles[t][(side + 1) % 3];
            uses.push_back({std::minmax(a, b), t});
        }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.edge, a.triangle) < std::tie(b.edge, b.triangle);
    });
    return uses;
}

std::string place(const TriangleSurface& surface, const Edge& edge) {
    const Point& a = surface.points[edge.first];
    const Point& b = surface.points[edge.second];
    return fmt::format("({:g}, {:g}, {:g})-({:g}, {:g}, {:g})", a[0], a[1], a[2], b[0], b[1], b[2]);
}

/// Numbers the shells by their first triangle.
std::vector<std::uint32_t> shells_of(const TriangleSurface& surface, const std::vector<EdgeUse>& uses) {
    UnionFind joined(surface.triangles.size());
    for (std::size_t i = 1; i < uses.size(); ++i)
        if (uses[i].edge == uses[i - 1].edge) joined.join(uses[i].triangle, uses[i - 1].triangle);
    return joined.labels();
}

/// Whether the ray from `origin` along a direction that no honest model is aligned with meets the triangle.
bool ray_meets(const Point& origin, const Point& a, const Point& b, const Point& c) {
    static const Point kDirection{0.538516480713, 0.291547594742, 0.790569415042};
    const auto minus = [](const Point& p, const Point& q) {
        return Point{p[0] - q[0], p[1] - q[1], p[2] - q[2]};
    };
    const auto cross = [](const Point& p, const Point& q) {
        return Point{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
    };
    const auto dot = [](const Point& p, const Point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; };
    const Point ab = minus(b, a);
    const Point ac = minus(c, a);
    const Point h = cross(kDirection, ac);
    const double determinant = dot(ab, h);
    if (determinant == 0) return false;
    const Point from_a = minus(origin, a);
    const double u = dot(from_a, h) / determinant;
    const Point q = cross(from_a, ab);
    const double v = dot(kDirection, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && dot(ac, q) / determinant > 0;
}

/// inside[a][b]: a point of shell a lies inside shell b.
std::vector<std::vector<bool>> nesting(const ClosedSurface& closed, std::size_t shells) {
    std::vector<std::vector<bool>> inside(shells, std::vector<bool>(shells, false));
    const auto& [surface, shell_of_triangle, bodies] = closed;
    std::vector<Point> sample(shells);
    for (std::size_t t = surface.triangles.size(); t-- > 0;)
        sample[shell_of_triangle[t]] = surface.points[surface.triangles[t][0]];
    for (std::size_t a = 0; a < shells; ++a)
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
            const auto& [i, j, k] = surface.triangles[t];
            const std::uint32_t b = shell_of_triangle[t];
            if (b != a && ray_meets(sample[a], surface.points[i], surface.points[j], surface.points[k]))
                inside[a][b] = !inside[a][b];
        }
    return inside;
}

/// A shell inside an even number of others is the outside of a body; inside an odd number, it is a cavity of
/// the innermost shell around it.
std::vector<std::vector<std::uint32_t>> bodies_of(const std::vector<std::vector<bool>>& inside) {
    const std::size_t shells = inside.size();
    std::vector<std::size_t> depth(shells);
    for (std::size_t a = 0; a < shells; ++a)
        depth[a] = std::count(inside[a].begin(), inside[a].end(), true);
    std::vector<std::vector<std::uint32_t>> bodies;
    for (std::uint32_t outer = 0; outer < shells; ++outer) {
        if (depth[outer] % 2 != 0) continue;
        bodies.push_back({outer});
        for (std::uint32_t inner = 0; inner < shells; ++inner)
            if (depth[inner] == depth[outer] + 1 && inside[inner][outer]) bodies.back().push_back(inner);
    }
    return bodies;
}

}  // namespace

TriangleSurface join_corners(const std::vector<Point>& corners) {
    TriangleSurface surface;
    std::map<Point, std::uint32_t> index_of;
    std::size_t flat = 0;
    for (std::size_t c = 0; c + 2 < corners.size(); c += 3) {
        std::array<std::uint32_t, 3> triangle{};
        for (int i = 0; i < 3; ++i) {
            Point point = corners[c + i];
            for (double& x : point) {
                if (!std::isfinite(x))
                    fail_input(
                        fmt::format("triangle {} (from 0) has a coordinate that is not finite", c / 3));
                x += 0.0;  // -0 and 0 are the same place
            }
            const auto [found, is_new] =
                index_of.try_emplace(point, static_cast<std::uint32_t>(surface.points.size()));
            if (is_new) surface.points.push_back(point);
            triangle[i] = found->second;
        }
        if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
            ++flat;
        else
            surface.triangles.push_back(triangle);
    }
    if (flat > 0)
        surface.notes.push_back({false, fmt::format("{} triangles with a repeated corner left out", flat)});
    if (surface.triangles.empty()) fail_input("the surface has no triangles");
    return surface;
}

ClosedSurface require_closed(TriangleSurface surface) {
    const std::vector<EdgeUse> uses = sorted_edges(surface);
    std::size_t open = 0;
    std::size_t crowded = 0;
    Edge first_open{};
    Edge first_crowded{};
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t next = i;
        while (next < uses.size() && uses[next].edge == uses[i].edge)
            ++next;
        if (next - i == 1 && open++ == 0) first_open = uses[i].edge;
        if (next - i > 2 && crowded++ == 0) first_crowded = uses[i].edge;
        i = next;
    }
    if (open > 0)
        fail_input(fmt::format("the surface has a hole: {} open edges, the first at {}; close it first", open,
                               place(surface, first_open)));
    if (crowded > 0)
        fail_input(
            fmt::format("the surface is not a boundary: {} edges belong to more than two triangles, the "
                        "first at {}",
                        crowded, place(surface, first_crowded)));
    ClosedSurface closed;
    closed.shell_of_triangle = shells_of(surface, uses);
    closed.surface = std::move(surface);
    const std::size_t shells =
        1 + *std::max_element(closed.shell_of_triangle.begin(), closed.shell_of_triangle.end());
    closed.bodies = bodies_of(nesting(closed, shells));
    return closed;
}

}  // namespace knead::tools
