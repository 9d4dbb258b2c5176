// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/tetrahedron_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace knead::tools {
namespace {

using Vec = Eigen::Vector3d;

constexpr std::uint32_t kLeafSize = 4;

double distance_to_segment(const Vec& p, const Vec& a, const Vec& b) {
    const Vec edge = b - a;
    const double along = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
    return (p - a - along * edge).norm();
}

double distance_to_triangle(const Vec& p, const Vec& a, const Vec& b, const Vec& c) {
    const Vec normal = (b - a).cross(c - a);
    const auto left_of = [&](const Vec& from, const Vec& to) {
        return normal.dot((to - from).cross(p - from)) >= 0;
    };
    if (left_of(a, b) && left_of(b, c) && left_of(c, a)) return std::abs((p - a).dot(normal)) / normal.norm();
    return std::min(
        {distance_to_segment(p, a, b), distance_to_segment(p, b, c), distance_to_segment(p, c, a)});
}

}  // namespace

struct NearestTetrahedra::Search {
    Vec point;
    double slack_m = 0;
    double best_m = std::numeric_limits<double>::infinity();
    std::vector<NearTetrahedron> found;
};

NearestTetrahedra::NearestTetrahedra(const std::vector<Point>& nodes_m,
                                 const std::vector<Tetrahedron>& tetrahedra)
    : nodes_m_(nodes_m), tetrahedra_(tetrahedra), order_(tetrahedra.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    std::vector<Vec> centres;
    centres.reserve(tetrahedra.size());
    for (std::uint32_t t = 0; t < tetrahedra.size(); ++t)
        centres.push_back(0.25 * (corner(t, 0) + corner(t, 1) + corner(t, 2) + corner(t, 3)));
    grow(0, static_cast<std::uint32_t>(tetrahedra.size()), centres);
}

Vec NearestTetrahedra::corner(std::uint32_t tetrahedron, int k) const {
    const Point& node = nodes_m_[tetrahedra_[tetrahedron][static_cast<std::size_t>(k)]];
    return {node[0], node[1], node[2]};
}

/// Halves the tetrahedra across the longest side of their box until few are left.
std::uint32_t NearestTetrahedra::grow(std::uint32_t begin, std::uint32_t end, const std::vector<Vec>& centres) {
    const auto index = static_cast<std::uint32_t>(branches_.size());
    Branch branch;
    branch.begin = begin;
    branch.end = end;
    for (std::uint32_t i = begin; i < end; ++i)
        for (int k = 0; k < 4; ++k)
            branch.box.extend(corner(order_[i], k));
    branches_.push_back(branch);
    if (end - begin <= kLeafSize) return index;
    Eigen::Index axis = 0;
    branch.box.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = centres[a][axis], y = centres[b][axis];
                         return x < y || (x == y && a < b);
                     });
    grow(begin, middle, centres);
    const std::uint32_t second = grow(middle, end, centres);
    branches_[index].second = second;
    return index;
}

NearTetrahedron NearestTetrahedra::locate(std::uint32_t tetrahedron, const Vec& point) const {
    const std::array<Vec, 4> corners{corner(tetrahedron, 0), corner(tetrahedron, 1), corner(tetrahedron, 2),
                                     corner(tetrahedron, 3)};
    const auto& [a, b, c, d] = corners;
    const Vec ab = b - a, ac = c - a, ad = d - a, ap = point - a;
    const double six_volumes = ab.dot(ac.cross(ad));
    NearTetrahedron near;
    near.tetrahedron = tetrahedron;
    near.weights[1] = ap.dot(ac.cross(ad)) / six_volumes;
    near.weights[2] = ap.dot(ad.cross(ab)) / six_volumes;
    near.weights[3] = ap.dot(ab.cross(ac)) / six_volumes;
    near.weights[0] = 1 - near.weights[1] - near.weights[2] - near.weights[3];
    // The nearest point of the tetrahedron lies on a face that the point is outside of.
    double distance_m = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 4; ++k)
        if (near.weights[k] < 0)
            distance_m =
                std::min(distance_m, distance_to_triangle(point, corners[(k + 1) % 4], corners[(k + 2) % 4],
                                                          corners[(k + 3) % 4]));
    if (distance_m < std::numeric_limits<double>::infinity()) near.distance_m = distance_m;
    return near;
}

void NearestTetrahedra::descend(std::uint32_t index, Search& search) const {
    const Branch& branch = branches_[index];
    if (branch.box.exteriorDistance(search.point) > search.best_m + search.slack_m) return;
    if (branch.second == 0) {
        for (std::uint32_t i = branch.begin; i < branch.end; ++i) {
            search.found.push_back(locate(order_[i], search.point));
            search.best_m = std::min(search.best_m, search.found.back().distance_m);
        }
        return;
    }
    const std::uint32_t first = index + 1;
    const bool second_is_nearer = branches_[branch.second].box.squaredExteriorDistance(search.point) <
                                  branches_[first].box.squaredExteriorDistance(search.point);
    descend(second_is_nearer ? branch.second : first, search);
    descend(second_is_nearer ? first : branch.second, search);
}

std::vector<NearTetrahedron> NearestTetrahedra::nearest(const Point& point, double slack_m) const {
    Search search;
    search.point = Vec(point[0], point[1], point[2]);
    search.slack_m = slack_m;
    descend(0, search);
    auto& found = search.found;
    found.erase(
        std::remove_if(found.begin(), found.end(),
                       [&](const NearTetrahedron& n) { return n.distance_m > search.best_m + slack_m; }),
        found.end());
    std::sort(found.begin(), found.end(), [](const NearTetrahedron& a, const NearTetrahedron& b) {
        return a.tetrahedron < b.tetrahedron;
    });
    return std::move(found);
}

}  // namespace knead::tools
