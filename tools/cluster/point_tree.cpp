// SPDX-License-Identifier: GPL-3.0-or-later
#include "cluster/point_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace knead::tools {
namespace {

constexpr std::uint32_t kLeafSize = 16;

double dot(const Point& a, const Point& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Middle of the bounding box: unlike a mean, it does not depend on the order of summation.
Point middle_of(std::span<const Point> points) {
    Point low = points[0];
    Point high = points[0];
    for (const Point& point : points)
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = std::min(low[axis], point[axis]);
            high[axis] = std::max(high[axis], point[axis]);
        }
    return {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])};
}

int widest_axis(const Point& low, const Point& high) {
    int widest = 0;
    for (int axis = 1; axis < 3; ++axis)
        if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
    return widest;
}

}  // namespace

std::uint32_t closest_centre(const Point& point, std::span<const Point> centres) {
    std::uint32_t best = 0;
    double best_distance = squared_distance(point, centres[0]);
    for (std::uint32_t centre = 1; centre < centres.size(); ++centre) {
        const double distance = squared_distance(point, centres[centre]);
        if (distance < best_distance) {
            best_distance = distance;
            best = centre;
        }
    }
    return best;
}

PointTree::PointTree(std::span<const Point> points)
    : origin_m_(middle_of(points)), points_m_(points.begin(), points.end()), original_index_(points.size()) {
    std::iota(original_index_.begin(), original_index_.end(), 0U);
    for (Point& point : points_m_)
        for (int axis = 0; axis < 3; ++axis)
            point[axis] -= origin_m_[axis];
    cells_.reserve(4 * points.size() / kLeafSize + 1);
    build(0, static_cast<std::uint32_t>(points.size()));
    std::vector<Point> in_tree_order(points_m_.size());
    for (std::size_t i = 0; i < in_tree_order.size(); ++i)
        in_tree_order[i] = points_m_[original_index_[i]];
    points_m_ = std::move(in_tree_order);
}

// While the tree is built, points_m_ still has the caller's order and original_index_ is what gets sorted.
std::uint32_t PointTree::build(std::uint32_t begin, std::uint32_t end) {
    const auto self = static_cast<std::uint32_t>(cells_.size());
    cells_.emplace_back();
    Cell cell;
    cell.begin = begin;
    cell.end = end;
    cell.low = cell.high = points_m_[original_index_[begin]];
    for (std::uint32_t i = begin; i < end; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            cell.low[axis] = std::min(cell.low[axis], points_m_[original_index_[i]][axis]);
            cell.high[axis] = std::max(cell.high[axis], points_m_[original_index_[i]][axis]);
        }
    const int widest = widest_axis(cell.low, cell.high);
    // A total order: whatever the numbering of the points, each of them ends up in the same place.
    const auto before = [this, widest](std::uint32_t a, std::uint32_t b) {
        const Point& p = points_m_[a];
        const Point& q = points_m_[b];
        return std::tie(p[widest], p, a) < std::tie(q[widest], q, b);
    };
    const auto first = original_index_.begin();
    if (end - begin <= kLeafSize) {
        std::sort(first + begin, first + end, before);
        sum_leaf(cell);
    } else {
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(first + begin, first + middle, first + end, before);
        const std::uint32_t left = build(begin, middle);
        cell.right_child = build(middle, end);
        sum_children(cell, left);
    }
    cells_[self] = cell;
    return self;
}

void PointTree::sum_leaf(Cell& cell) {
    for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
        const Point& point = points_m_[original_index_[i]];
        for (int axis = 0; axis < 3; ++axis)
            cell.sum[axis] += point[axis];
        cell.sum_of_squares += dot(point, point);
    }
}

void PointTree::sum_children(Cell& cell, std::uint32_t left) {
    for (const std::uint32_t child : {left, cell.right_child}) {
        for (int axis = 0; axis < 3; ++axis)
            cell.sum[axis] += cells_[child].sum[axis];
        cell.sum_of_squares += cells_[child].sum_of_squares;
    }
}

double PointTree::diagonal_m() const {
    return std::sqrt(squared_distance(cells_[0].low, cells_[0].high));
}

/// One pass down the tree. Candidates of a cell are the centres that may be closest to a point in it.
class PointTree::Assigner {
  public:
    Assigner(const PointTree& tree, std::span<const Point> centres) : tree_(tree), centres_(centres) {
        sums_.position_sum_m.resize(centres.size());
        sums_.count.resize(centres.size());
        candidates_.resize(centres.size());
        std::iota(candidates_.begin(), candidates_.end(), 0U);
    }

    AssignmentSums run() {
        visit(0, 0, candidates_.size());
        return std::move(sums_);
    }

  private:
    /// The candidates of a cell are candidates_[begin, end); those of its children are appended behind.
    void visit(std::uint32_t index, std::size_t begin, std::size_t end) {
        const Cell& cell = tree_.cells_[index];
        if (end - begin == 1) return take_cell(cell, candidates_[begin]);
        if (cell.right_child == 0) return take_points(cell, begin, end);
        const std::size_t kept_begin = candidates_.size();
        keep_competitive(cell, begin, end);
        const std::size_t kept_end = candidates_.size();
        visit(index + 1, kept_begin, kept_end);
        visit(cell.right_child, kept_begin, kept_end);
        candidates_.resize(kept_begin);
    }

    void take_cell(const Cell& cell, std::uint32_t centre) {
        const Point& c = centres_[centre];
        const double count = cell.end - cell.begin;
        for (int axis = 0; axis < 3; ++axis)
            sums_.position_sum_m[centre][axis] += cell.sum[axis];
        sums_.count[centre] += cell.end - cell.begin;
        sums_.inertia_m2 += cell.sum_of_squares - 2.0 * dot(c, cell.sum) + count * dot(c, c);
    }

    void take_points(const Cell& cell, std::size_t begin, std::size_t end) {
        for (std::uint32_t i = cell.begin; i < cell.end; ++i) {
            const Point& point = tree_.points_m_[i];
            const std::uint32_t centre = closest_candidate(point, begin, end);
            for (int axis = 0; axis < 3; ++axis)
                sums_.position_sum_m[centre][axis] += point[axis];
            ++sums_.count[centre];
            sums_.inertia_m2 += squared_distance(point, centres_[centre]);
        }
    }

    std::uint32_t closest_candidate(const Point& point, std::size_t begin, std::size_t end) const {
        std::uint32_t best = candidates_[begin];
        double best_distance = squared_distance(point, centres_[best]);
        for (std::size_t i = begin + 1; i < end; ++i) {
            const double distance = squared_distance(point, centres_[candidates_[i]]);
            if (distance < best_distance) {
                best_distance = distance;
                best = candidates_[i];
            }
        }
        return best;
    }

    /// Appends the candidates that are not farther than the cell's favourite from every point of the cell.
    void keep_competitive(const Cell& cell, std::size_t begin, std::size_t end) {
        Point middle{};
        for (int axis = 0; axis < 3; ++axis)
            middle[axis] = 0.5 * (cell.low[axis] + cell.high[axis]);
        const std::uint32_t favourite = closest_candidate(middle, begin, end);
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t candidate = candidates_[i];
            if (candidate == favourite || !loses_everywhere(centres_[candidate], centres_[favourite], cell))
                candidates_.push_back(candidate);
        }
    }

    /// True if `rival` is farther than `favourite` even from the corner of the cell that suits it best.
    /// Strictly farther: a tie is left to the points, where the lower index wins.
    static bool loses_everywhere(const Point& rival, const Point& favourite, const Cell& cell) {
        Point corner{};
        for (int axis = 0; axis < 3; ++axis)
            corner[axis] = rival[axis] > favourite[axis] ? cell.high[axis] : cell.low[axis];
        return squared_distance(rival, corner) > squared_distance(favourite, corner);
    }

    const PointTree& tree_;
    std::span<const Point> centres_;
    std::vector<std::uint32_t> candidates_;
    AssignmentSums sums_;
};

AssignmentSums PointTree::assign(std::span<const Point> centres_m) const {
    return Assigner(*this, centres_m).run();
}

}  // namespace knead::tools
