// SPDX-License-Identifier: GPL-3.0-or-later
#include "aggregate/tetrahedron_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace knead::tools {
namespace {

constexpr std::uint32_t kLeafSize = 8;
constexpr std::uint32_t kNone = UINT32_MAX;
/// A point is inside when no barycentric coordinate is below minus this: rounding of volumes of ordinary
/// meshes stays orders below it, and a point outside by so little may as well start in this tetrahedron.
constexpr double kInsideTolerance = 1e-12;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double squared_distance_to_box(const Point& point, const Point& low, const Point& high) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double outside = std::max({low[axis] - point[axis], 0.0, point[axis] - high[axis]});
        sum += outside * outside;
    }
    return sum;
}

void extend(Point& low, Point& high, const Point& point) {
    for (int axis = 0; axis < 3; ++axis) {
        low[axis] = std::min(low[axis], point[axis]);
        high[axis] = std::max(high[axis], point[axis]);
    }
}

}  // namespace

TetrahedronTree::TetrahedronTree(const TetMesh& mesh)
    : mesh_(mesh),
      barycentre_m_(mesh.tetrahedra.size()),
      order_(mesh.tetrahedra.size()),
      place_(mesh.tetrahedra.size()),
      removed_(mesh.tetrahedra.size(), false) {
    for (std::size_t t = 0; t < barycentre_m_.size(); ++t)
        barycentre_m_[t] = barycentre_m(mesh, t);
    std::iota(order_.begin(), order_.end(), 0U);
    cells_.reserve(4 * order_.size() / kLeafSize + 1);
    build(0, static_cast<std::uint32_t>(order_.size()));
    for (std::uint32_t place = 0; place < order_.size(); ++place)
        place_[order_[place]] = place;
}

void TetrahedronTree::fit(Cell& cell) const {
    constexpr Point kHighest{kInfinity, kInfinity, kInfinity};
    constexpr Point kLowest{-kInfinity, -kInfinity, -kInfinity};
    cell.barycentres = cell.tetrahedra = {kHighest, kLowest};
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
        extend(cell.barycentres.low, cell.barycentres.high, barycentre_m_[order_[i]]);
        for (const std::uint32_t node : mesh_.tetrahedra[order_[i]])
            extend(cell.tetrahedra.low, cell.tetrahedra.high, mesh_.nodes_m[node]);
    }
}

std::uint32_t TetrahedronTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto self = static_cast<std::uint32_t>(cells_.size());
    cells_.emplace_back();
    Cell cell;
    cell.begin = begin;
    cell.end = end;
    cell.present = end - begin;
    fit(cell);
    if (end - begin > kLeafSize) {
        int widest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (cell.barycentres.high[axis] - cell.barycentres.low[axis] >
                cell.barycentres.high[widest] - cell.barycentres.low[widest])
                widest = axis;
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                         [this, widest](std::uint32_t a, std::uint32_t b) {
                             return std::tie(barycentre_m_[a][widest], a) <
                                    std::tie(barycentre_m_[b][widest], b);
                         });
        build(begin, middle);
        cell.right_child = build(middle, end);
    }
    cells_[self] = cell;
    return self;
}

bool TetrahedronTree::contains(std::uint32_t tetrahedron, const Point& point) const {
    const double least = -kInsideTolerance * signed_volume_m3(mesh_, tetrahedron);
    std::array<Point, 4> corners{};
    for (int i = 0; i < 4; ++i)
        corners[i] = mesh_.nodes_m[mesh_.tetrahedra[tetrahedron][i]];
    for (int i = 0; i < 4; ++i) {
        std::array<Point, 4> part = corners;
        part[i] = point;
        if (signed_volume_m3(part[0], part[1], part[2], part[3]) < least) return false;
    }
    return true;
}

std::optional<std::uint32_t> TetrahedronTree::containing(const Point& point) const {
    std::uint32_t found = kNone;
    search_containing(0, point, found);
    return found == kNone ? std::nullopt : std::optional(found);
}

void TetrahedronTree::search_containing(std::uint32_t index, const Point& point, std::uint32_t& found) const {
    const Cell& cell = cells_[index];
    if (squared_distance_to_box(point, cell.tetrahedra.low, cell.tetrahedra.high) > 0) return;
    if (cell.right_child != 0) {
        search_containing(index + 1, point, found);
        search_containing(cell.right_child, point, found);
        return;
    }
    for (std::uint32_t i = cell.begin; i < cell.end; ++i)
        if (order_[i] < found && contains(order_[i], point)) found = order_[i];
}

std::uint32_t TetrahedronTree::nearest(const Point& point) const {
    Nearest best{false, kInfinity, kNone};
    search_nearest(0, point, best);
    return best.tetrahedron;
}

std::optional<std::uint32_t> TetrahedronTree::nearest_present(const Point& point) const {
    Nearest best{true, kInfinity, kNone};
    search_nearest(0, point, best);
    return best.tetrahedron == kNone ? std::nullopt : std::optional(best.tetrahedron);
}

void TetrahedronTree::search_nearest(std::uint32_t index, const Point& point, Nearest& best) const {
    const Cell& cell = cells_[index];
    if (best.present_only && cell.present == 0) return;
    if (squared_distance_to_box(point, cell.barycentres.low, cell.barycentres.high) > best.squared_distance)
        return;
    if (cell.right_child == 0) {
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const std::uint32_t tetrahedron = order_[i];
            if (best.present_only && removed_[tetrahedron]) continue;
            const Point& b = barycentre_m_[tetrahedron];
            const double distance = squared_distance_to_box(point, b, b);
            if (std::tie(distance, tetrahedron) < std::tie(best.squared_distance, best.tetrahedron))
                best = {best.present_only, distance, tetrahedron};
        }
        return;
    }
    std::array<std::uint32_t, 2> children{index + 1, cell.right_child};
    const auto distance_to = [&](std::uint32_t child) {
        return squared_distance_to_box(point, cells_[child].barycentres.low, cells_[child].barycentres.high);
    };
    if (distance_to(children[1]) < distance_to(children[0])) std::swap(children[0], children[1]);
    for (const std::uint32_t child : children)
        search_nearest(child, point, best);
}

void TetrahedronTree::remove(std::uint32_t tetrahedron) {
    removed_[tetrahedron] = true;
    const std::uint32_t place = place_[tetrahedron];
    std::uint32_t index = 0;
    while (true) {
        Cell& cell = cells_[index];
        --cell.present;
        if (cell.right_child == 0) return;
        index = place < cells_[cell.right_child].begin ? index + 1 : cell.right_child;
    }
}

}  // namespace knead::tools
