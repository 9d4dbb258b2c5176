// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "knead/formats/tet_mesh.h"

namespace knead::tools {

/// What one assignment of all points to their closest centres adds up to.
struct AssignmentSums {
    std::vector<Point> position_sum_m;  ///< [centres] sum of the points of each centre
    std::vector<std::uint64_t> count;   ///< [centres] number of points of each centre
    double inertia_m2 = 0;              ///< sum over all points of the squared distance to their centre
};

/// A k-d tree over points that remembers the sums of each cell, so that one step of Lloyd's algorithm visits
/// only the cells that more than one centre competes for (the filtering algorithm: Kanungo et al., "An
/// efficient k-means clustering algorithm: analysis and implementation", IEEE PAMI 24(7), 2002).
///
/// Positions inside the tree count from the middle of the points' box, which keeps the sums of squares
/// accurate.
/// The tree, and every sum it gives, depend on the set of points and not on their order, as long as no two
/// points coincide. Immutable after construction: safe to read from several threads.
class PointTree {
  public:
    /// @param points not empty, finite
    explicit PointTree(std::span<const Point> points);

    /// Points relative to origin_m(), in the order of the tree.
    [[nodiscard]] const std::vector<Point>& points_m() const noexcept { return points_m_; }
    /// Index in the span given to the constructor of each of points_m().
    [[nodiscard]] const std::vector<std::uint32_t>& original_index() const noexcept {
        return original_index_;
    }
    [[nodiscard]] const Point& origin_m() const noexcept { return origin_m_; }
    /// Longest diagonal: a length to measure movements against.
    [[nodiscard]] double diagonal_m() const;

    /// Gives each point to its closest centre (ties: the lower index) and sums up.
    /// @param centres_m relative to origin_m(), not empty
    [[nodiscard]] AssignmentSums assign(std::span<const Point> centres_m) const;

  private:
    struct Cell {
        Point low{};
        Point high{};
        Point sum{};
        double sum_of_squares = 0;
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
        std::uint32_t right_child = 0;  ///< 0: a leaf; the left child is the next cell
    };
    class Assigner;

    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    void sum_leaf(Cell& cell);
    void sum_children(Cell& cell, std::uint32_t left);

    Point origin_m_{};
    std::vector<Point> points_m_;
    std::vector<std::uint32_t> original_index_;
    std::vector<Cell> cells_;
};

/// Index of the centre closest to a point; ties: the lower index. Precondition: centres not empty.
[[nodiscard]] std::uint32_t closest_centre(const Point& point, std::span<const Point> centres);

[[nodiscard]] inline double squared_distance(const Point& a, const Point& b) {
    const double x = a[0] - b[0];
    const double y = a[1] - b[1];
    const double z = a[2] - b[2];
    return x * x + y * y + z * z;
}

}  // namespace knead::tools
